# The `hop` command as a user types it: broken configurations and command lines, and what every verb keeps to.
if(TARGET hop AND TARGET hopperd)
  foreach(name broken verbs campaign)
    add_test(NAME cli.${name} COMMAND node ${PROJECT_SOURCE_DIR}/tests/cli/${name}.mjs ${CMAKE_BINARY_DIR})
    set_tests_properties(cli.${name} PROPERTIES LABELS cli TIMEOUT 120)
  endforeach()
  add_test(NAME cli.diagnose COMMAND node ${PROJECT_SOURCE_DIR}/tests/cli/diagnose.mjs ${CMAKE_BINARY_DIR})
  set_tests_properties(cli.diagnose PROPERTIES LABELS cli TIMEOUT 300)
endif()
