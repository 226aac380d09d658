# Test of the comparison of golden answers. The answers themselves are kept and compared by hand (tests/golden/golden.mjs).
add_test(NAME golden.differences COMMAND node ${PROJECT_SOURCE_DIR}/tests/golden/differences_test.mjs)
set_tests_properties(golden.differences PROPERTIES LABELS golden TIMEOUT 30)
