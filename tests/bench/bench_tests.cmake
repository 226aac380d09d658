# Tests that need the virtual bench's kernel. It is built once before all of them, so that these minutes do not count
# towards the time limit of a test.
if(SANDHOPPER_SANITIZE MATCHES "address|thread")
  message(WARNING "The tests on the bench are left out: AddressSanitizer and ThreadSanitizer map more than the 39 address "
    "bits that a process has there. UBSan alone runs there: cmake --preset default -DSANDHOPPER_SANITIZE=undefined")
  return()
endif()
add_test(NAME bench.kernel COMMAND ${PROJECT_SOURCE_DIR}/tools/virtual_bench/build_kernel)
set_tests_properties(bench.kernel PROPERTIES LABELS bench TIMEOUT 3600 FIXTURES_SETUP bench_kernel)
add_executable(can_playback tests/bench/can_playback.cpp)
target_link_libraries(can_playback PRIVATE sandhopper_firmware)
set_target_properties(can_playback PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
add_test(NAME bench.can_playback
  COMMAND ${PROJECT_SOURCE_DIR}/tools/bench --no-devices --time-limit 900 ${CMAKE_BINARY_DIR}/bin/can_playback
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(bench.can_playback PROPERTIES LABELS bench SKIP_RETURN_CODE 77 TIMEOUT 1200
  ENVIRONMENT SANDHOPPER_NO_BUILD=1)
add_test(NAME bench.agreement COMMAND ${PROJECT_SOURCE_DIR}/tests/bench/agreement)
set_tests_properties(bench.agreement PROPERTIES LABELS bench TIMEOUT 2400 ENVIRONMENT SANDHOPPER_NO_BUILD=1)

add_executable(bench_tests tests/bench/linux_board_test.cpp tests/bench/gpio_test.cpp
  tests/bench/guard_process_test.cpp tests/unit/allocation_guard.cpp)
target_link_libraries(bench_tests PRIVATE sandhopper_firmware GTest::gmock GTest::gtest_main)
target_compile_definitions(bench_tests PRIVATE SANDHOPPER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
set_target_properties(bench_tests PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
add_test(NAME bench.linux_board
  COMMAND ${PROJECT_SOURCE_DIR}/tools/bench --time-limit 900 ${CMAKE_BINARY_DIR}/bin/bench_tests
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(bench.linux_board PROPERTIES LABELS bench TIMEOUT 1200 ENVIRONMENT SANDHOPPER_NO_BUILD=1)

# The bench itself: its behaviour for any command, its devices, and identical runs.
add_executable(spi_probe tests/bench/spi_probe.cpp)
target_link_libraries(spi_probe PRIVATE sandhopper_options)
set_target_properties(spi_probe PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
foreach(name boot devices determinism calibrate watchdog guard)
  add_test(NAME bench.${name} COMMAND ${PROJECT_SOURCE_DIR}/tests/bench/${name})
  set_tests_properties(bench.${name} PROPERTIES LABELS bench TIMEOUT 2400 ENVIRONMENT SANDHOPPER_NO_BUILD=1)
endforeach()

# hopperd as a process with a CAN bus.
foreach(name on_the_bus remembers)
  add_test(NAME daemon.${name}
    COMMAND ${PROJECT_SOURCE_DIR}/tools/bench --time-limit 900 ${PROJECT_SOURCE_DIR}/tests/daemon/${name}
            ${CMAKE_BINARY_DIR}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(daemon.${name} PROPERTIES LABELS bench TIMEOUT 1200 ENVIRONMENT SANDHOPPER_NO_BUILD=1)
endforeach()

set_tests_properties(bench.can_playback bench.agreement bench.linux_board bench.boot bench.devices bench.determinism
  bench.calibrate bench.watchdog bench.guard daemon.on_the_bus daemon.remembers
  PROPERTIES FIXTURES_REQUIRED bench_kernel)
