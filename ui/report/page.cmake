# The page's script and style sheet: npm packages as the lock file pins them, bundled by esbuild in the build directory (the source tree is never
# written to), and embedded by print/page_assets.cpp. Also the type check, which is part of the build, and where the page's tests run.
find_program(NPM npm)
find_program(NODE NAMES node nodejs)
if(NOT NPM OR NOT NODE)
  message(FATAL_ERROR "cavum: ui/report/page: npm is not on the PATH, and the reports' script is bundled with it; install nodejs and npm (./dev build does)")
endif()
set(page_source ${CMAKE_CURRENT_SOURCE_DIR}/page)
set(page_build ${CMAKE_CURRENT_BINARY_DIR}/page)
file(MAKE_DIRECTORY ${page_build})
# seen through links, sources find node_modules beside them
file(CREATE_LINK ${page_source}/src ${page_build}/src SYMBOLIC)
file(CREATE_LINK ${CMAKE_SOURCE_DIR}/tests/ui/report/page ${page_build}/test SYMBOLIC)
add_custom_command(
  OUTPUT ${page_build}/node_modules.stamp
  DEPENDS ${page_source}/package.json ${page_source}/package-lock.json
  COMMAND ${CMAKE_COMMAND} -E copy ${page_source}/package.json ${page_source}/package-lock.json ${page_build}
  COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
  COMMAND ${CMAKE_COMMAND} -E touch ${page_build}/node_modules.stamp
  WORKING_DIRECTORY ${page_build}
  COMMENT "npm packages of the report page"
  VERBATIM)
file(GLOB page_files CONFIGURE_DEPENDS ${page_source}/src/*.ts ${page_source}/src/*.css)
add_custom_command(
  OUTPUT ${page_build}/page.js ${page_build}/page.css
  DEPENDS ${page_build}/node_modules.stamp ${page_source}/build.mjs ${page_source}/tsconfig.json ${page_files}
  COMMAND ${CMAKE_COMMAND} -E copy ${page_source}/build.mjs ${page_source}/tsconfig.json ${page_build}
  COMMAND ${NODE} node_modules/typescript/bin/tsc --noEmit -p tsconfig.json
  COMMAND ${NODE} build.mjs
  WORKING_DIRECTORY ${page_build}
  COMMENT "script and style sheet of the report page"
  VERBATIM)
add_custom_target(cavum_page DEPENDS ${page_build}/page.js ${page_build}/page.css)
add_dependencies(cavum_report cavum_page)
set_source_files_properties(print/page_assets.cpp PROPERTIES OBJECT_DEPENDS "${page_build}/page.js;${page_build}/page.css"
                            COMPILE_DEFINITIONS "CAVUM_PAGE_DIR=\"${page_build}\"")
