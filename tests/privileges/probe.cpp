// Opens a socket of the internet: what confine must not let pass, so that the test of hopperd is worth
// something.
#include <sys/socket.h>

int main() { return ::socket(AF_INET, SOCK_STREAM, 0) >= 0 ? 0 : 1; }
