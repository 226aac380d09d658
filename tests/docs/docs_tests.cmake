# The documentation: its links, and the commands in it.
if(TARGET hop)
  add_test(NAME docs.pages COMMAND ${PROJECT_SOURCE_DIR}/tools/docs/build ${CMAKE_BINARY_DIR}/docs)
  add_test(NAME docs.commands COMMAND node ${PROJECT_SOURCE_DIR}/tests/docs/commands.mjs ${CMAKE_BINARY_DIR})
  set_tests_properties(docs.pages docs.commands PROPERTIES LABELS docs TIMEOUT 1800)
endif()
