// confine COMMAND…: runs a command and kills it if it opens a socket of another family than AF_UNIX and
// AF_CAN, or changes its user or capabilities. It replaces systemd's RestrictAddressFamilies= on machines
// without systemd.
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>

namespace {

constexpr std::uint32_t load(std::size_t offset) { return static_cast<std::uint32_t>(offset); }
constexpr std::size_t kFamily = offsetof(seccomp_data, args);  // first argument of socket(2); little-endian

// Jump distances count the instructions to skip.
constexpr std::array kFilter{
    sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, load(offsetof(seccomp_data, nr))),
    sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_capset, 5, 0),
    sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_setuid, 4, 0),
    sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_socket, 0, 4),
    sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, load(kFamily)),
    sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AF_UNIX, 2, 0),
    sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AF_CAN, 1, 0),
    sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
    sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  auto filter = kFilter;
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) {
    std::perror("confine");
    return 77;
  }
  ::execv(argv[1], argv + 1);
  std::perror(argv[1]);
  return 3;
}
