# A report opened in headless Chromium: plots drawn, zoom, no complaint on the console, no request to any network.
add_executable(sample_page tests/report/sample_page.cpp)
target_link_libraries(sample_page PRIVATE sandhopper_report)
set_target_properties(sample_page PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
add_test(NAME report.page_in_browser
         COMMAND node ${PROJECT_SOURCE_DIR}/tests/report/page_test.mjs ${CMAKE_BINARY_DIR})
set_tests_properties(report.page_in_browser PROPERTIES LABELS report TIMEOUT 900 SKIP_RETURN_CODE 77)
add_test(NAME report.study_in_browser
         COMMAND node ${PROJECT_SOURCE_DIR}/tests/report/study_test.mjs ${CMAKE_BINARY_DIR})
set_tests_properties(report.study_in_browser PROPERTIES LABELS report TIMEOUT 900 SKIP_RETURN_CODE 77)
add_test(NAME report.diagnosis_in_browser
         COMMAND node ${PROJECT_SOURCE_DIR}/tests/report/diagnosis_test.mjs ${CMAKE_BINARY_DIR})
set_tests_properties(report.diagnosis_in_browser PROPERTIES LABELS report TIMEOUT 900 SKIP_RETURN_CODE 77)
add_test(NAME report.explain_in_browser
         COMMAND node ${PROJECT_SOURCE_DIR}/tests/report/explain_test.mjs ${CMAKE_BINARY_DIR})
set_tests_properties(report.explain_in_browser PROPERTIES LABELS report TIMEOUT 900 SKIP_RETURN_CODE 77)
add_test(NAME report.layout_in_browser COMMAND node ${PROJECT_SOURCE_DIR}/tests/report/layout_test.mjs)
set_tests_properties(report.layout_in_browser PROPERTIES LABELS report TIMEOUT 900 SKIP_RETURN_CODE 77)
