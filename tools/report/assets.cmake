# Concatenates scripts of `folder`, in the order of their names in the arguments, into `variable`.
function(sandhopper_join_scripts variable folder)
  set(text "")
  foreach(name ${ARGN})
    file(READ ${folder}/${name}.js content)
    string(APPEND text "${content}\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder}/${name}.js)
  endforeach()
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

# Embeds the reports' pages and Debian's dygraphs into the library: a program must write reports on a machine that
# has neither. CMake runs again when one of the files changes.
function(sandhopper_embed_report_assets target)
  set(page ${PROJECT_SOURCE_DIR}/tools/report/page)
  find_path(DYGRAPHS_DIR dygraph.min.js PATHS /usr/share/javascript/dygraphs NO_DEFAULT_PATH)
  if(NOT DYGRAPHS_DIR)
    message(FATAL_ERROR "dygraphs not found: run tools/setup (Debian package libjs-dygraphs), "
                        "or set DYGRAPHS_DIR to the folder that holds dygraph.min.js")
  endif()

  foreach(asset "kPage|${page}/page.html" "kStyle|${page}/page.css" "kStudyPage|${page}/study.html"
                "kStudyStyle|${page}/study.css" "kExplainPage|${page}/explain.html"
                "kExplainStyle|${page}/explain.css" "kPlotStyle|${DYGRAPHS_DIR}/dygraph.min.css"
                "kPlotScript|${DYGRAPHS_DIR}/dygraph.min.js")
    string(REPLACE "|" ";" asset "${asset}")
    list(GET asset 0 name)
    list(GET asset 1 file)
    file(READ ${file} content)
    # Without this, a browser's developer tools would request the source map, which is not embedded.
    string(REGEX REPLACE "(//|/\\*)# sourceMappingURL=[^\n]*" "" ${name} "${content}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  endforeach()
  file(READ ${page}/fitted_table.css content)
  string(APPEND kStyle "${content}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page}/fitted_table.css)
  sandhopper_join_scripts(kScript ${page} data theme legend fitted_table svg panels time_plots profile_band force_depth stiffness_chart tables main)
  sandhopper_join_scripts(kStudyScript ${page} data theme legend fitted_table svg study_figure math answers study)

  sandhopper_join_scripts(kExplainScript ${page} data theme legend fitted_table explain_panels time_plots tables explain)

  configure_file(${PROJECT_SOURCE_DIR}/tools/report/assets.cpp.in
                 ${PROJECT_BINARY_DIR}/generated/report_assets.cpp @ONLY)
  # The literals are longer than ISO C++ guarantees. Supported compilers accept them, Clang with a warning.
  set_source_files_properties(${PROJECT_BINARY_DIR}/generated/report_assets.cpp PROPERTIES
                              COMPILE_OPTIONS -Wno-overlength-strings)
  target_sources(${target} PRIVATE ${PROJECT_BINARY_DIR}/generated/report_assets.cpp)
endfunction()
