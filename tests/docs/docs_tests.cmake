# The documentation: its links, the commands in it, and the tests behind what its safety page promises.
if(TARGET hop)
  add_test(NAME docs.pages COMMAND ${PROJECT_SOURCE_DIR}/tools/docs/build ${CMAKE_BINARY_DIR}/docs)
  add_test(NAME docs.commands COMMAND node ${PROJECT_SOURCE_DIR}/tests/docs/commands.mjs ${CMAKE_BINARY_DIR})
  add_test(NAME docs.proofs COMMAND ${PROJECT_SOURCE_DIR}/tests/docs/proofs ${CMAKE_BINARY_DIR})
  set_tests_properties(docs.pages docs.commands docs.proofs PROPERTIES LABELS docs TIMEOUT 1800)
endif()
