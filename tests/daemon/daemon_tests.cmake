# hopperd as a process: how it ends, who notices that its cycle stands still, what it says of time it lost.
add_executable(hold_thread tests/daemon/hold_thread.cpp)
target_link_libraries(hold_thread PRIVATE sandhopper_options)
add_executable(overruns_in_log tests/daemon/overruns_in_log.cpp)
target_link_libraries(overruns_in_log PRIVATE sandhopper_firmware)
set_target_properties(hold_thread overruns_in_log PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
foreach(name signals overruns log_files)
  add_test(NAME daemon.${name} COMMAND ${PROJECT_SOURCE_DIR}/tests/daemon/${name} ${CMAKE_BINARY_DIR})
  set_tests_properties(daemon.${name} PROPERTIES LABELS daemon TIMEOUT 180 RUN_SERIAL ON)
endforeach()
add_test(NAME daemon.on_the_bus
  COMMAND ${PROJECT_SOURCE_DIR}/tools/bench --time-limit 240 ${PROJECT_SOURCE_DIR}/tests/daemon/on_the_bus
          ${CMAKE_BINARY_DIR}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(daemon.on_the_bus PROPERTIES LABELS bench TIMEOUT 600 ENVIRONMENT SANDHOPPER_NO_BUILD=1
  FIXTURES_REQUIRED bench_kernel)
