# The documentation: pages and links, paths, its commands, its campaigns, the tests behind the promises of its safety page, and
# the pages in a browser.
add_test(NAME docs.paths COMMAND ${PROJECT_SOURCE_DIR}/tests/docs/paths)
add_test(NAME docs.paths_check COMMAND ${PROJECT_SOURCE_DIR}/tests/docs/paths --self-test)
set_tests_properties(docs.paths docs.paths_check PROPERTIES LABELS docs)
if(TARGET hop)
  add_test(NAME docs.pages
           COMMAND ${PROJECT_SOURCE_DIR}/tools/docs/build --programs ${CMAKE_BINARY_DIR} ${CMAKE_BINARY_DIR}/docs)
  add_test(NAME docs.site_in_browser COMMAND node ${PROJECT_SOURCE_DIR}/tests/docs/site.mjs ${CMAKE_BINARY_DIR})
  add_test(NAME docs.commands COMMAND node ${PROJECT_SOURCE_DIR}/tests/docs/commands.mjs ${CMAKE_BINARY_DIR})
  add_test(NAME docs.minimal_campaigns
           COMMAND node ${PROJECT_SOURCE_DIR}/tests/docs/minimal_campaigns.mjs ${CMAKE_BINARY_DIR})
  add_test(NAME docs.ready_campaigns COMMAND ${PROJECT_SOURCE_DIR}/tests/docs/ready_campaigns ${CMAKE_BINARY_DIR})
  add_test(NAME docs.proofs COMMAND ${PROJECT_SOURCE_DIR}/tests/docs/proofs ${CMAKE_BINARY_DIR})
  set_tests_properties(docs.pages PROPERTIES FIXTURES_SETUP docs_pages)
  set_tests_properties(docs.site_in_browser PROPERTIES FIXTURES_REQUIRED docs_pages SKIP_RETURN_CODE 77)
  set_tests_properties(docs.pages docs.site_in_browser docs.commands docs.minimal_campaigns docs.ready_campaigns docs.proofs
                       PROPERTIES LABELS docs TIMEOUT 1800)
endif()
