# The generator of concealed campaigns, linked with no other code of the project. If it used any, this would not link.
file(GLOB conceal_test_sources CONFIGURE_DEPENDS tests/conceal/*.cpp)
add_executable(conceal_tests ${conceal_test_sources})
target_link_libraries(conceal_tests PRIVATE sandhopper_conceal GTest::gmock GTest::gtest_main)
target_compile_definitions(conceal_tests PRIVATE SANDHOPPER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
set_target_properties(conceal_tests PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
gtest_discover_tests(conceal_tests DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES PROPERTIES LABELS conceal TIMEOUT 120)
add_test(NAME conceal.independence
         COMMAND ${PROJECT_SOURCE_DIR}/tests/conceal/independence ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR})
set_tests_properties(conceal.independence PROPERTIES LABELS conceal TIMEOUT 300)
