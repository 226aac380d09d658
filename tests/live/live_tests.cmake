# The live view of `hop trial` in a terminal.
if(TARGET hop AND TARGET hopperd)
  foreach(name view ssh)
    add_test(NAME live.${name} COMMAND ${PROJECT_SOURCE_DIR}/tests/live/${name} ${CMAKE_BINARY_DIR})
    set_tests_properties(live.${name} PROPERTIES LABELS live TIMEOUT 240 SKIP_RETURN_CODE 77)
  endforeach()
  add_test(NAME daemon.stopped_reader COMMAND ${PROJECT_SOURCE_DIR}/tests/daemon/stopped_reader ${CMAKE_BINARY_DIR})
  set_tests_properties(daemon.stopped_reader PROPERTIES LABELS daemon TIMEOUT 120 RUN_SERIAL ON)
endif()
