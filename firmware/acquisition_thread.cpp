#include "firmware/acquisition_thread.hpp"

#include <pthread.h>
#include <sched.h>

#include <cerrno>

#include "drivers/device_error.hpp"

namespace sandhopper {

AcquisitionThread::AcquisitionThread(const Setup& setup, std::function<void()> step)
    : thread_([step = std::move(step)](const std::stop_token& stop) {
        while (!stop.stop_requested()) step();
      }) {
  const auto handle = thread_.native_handle();
  ::pthread_setname_np(handle, setup.name.c_str());
  if (setup.priority == 0) return;
  const sched_param parameter{setup.priority};
  errno = ::pthread_setschedparam(handle, SCHED_FIFO, &parameter);
  if (errno != 0)
    throw DeviceError(
        "thread " + setup.name, errno_cause("SCHED_FIFO " + std::to_string(setup.priority) + " refused"),
        "Run as root, or give the program CAP_SYS_NICE and an rtprio limit, or set thread_priority = 0");
}

}  // namespace sandhopper
