# A separate program, because it needs only a small part of the project.
file(GLOB fault_test_sources CONFIGURE_DEPENDS tests/faults/*.cpp)
add_executable(fault_tests ${fault_test_sources})
target_link_libraries(fault_tests PRIVATE sandhopper_faults GTest::gmock GTest::gtest_main)
target_compile_definitions(fault_tests PRIVATE SANDHOPPER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
set_target_properties(fault_tests PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
gtest_discover_tests(fault_tests DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES PROPERTIES LABELS faults)
