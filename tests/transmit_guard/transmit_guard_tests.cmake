# A separate program, because it needs only a small part of the project.
file(GLOB transmit_guard_test_sources CONFIGURE_DEPENDS tests/transmit_guard/*.cpp)
add_executable(transmit_guard_tests ${transmit_guard_test_sources} tests/unit/allocation_guard.cpp)
target_link_libraries(transmit_guard_tests PRIVATE sandhopper_faults GTest::gmock GTest::gtest_main)
target_compile_definitions(transmit_guard_tests PRIVATE SANDHOPPER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
set_target_properties(transmit_guard_tests PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
gtest_discover_tests(transmit_guard_tests DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES PROPERTIES LABELS faults)
