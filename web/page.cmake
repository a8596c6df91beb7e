# The page: burr in a browser. Everything that only a browser has lies here; the rooms of src/burr are compiled as they are.
#
#     cmake --preset web && cmake --build --preset web        -> build/web/site, a folder for any static host
#
# One WebAssembly module, burr_page, is loaded twice: in the page, where it draws, and in a worker, where it ticks.

# header-only libraries of this machine, alone: beside them in /usr/include lie the headers of another C library
set(headers ${CMAKE_BINARY_DIR}/web/headers)
file(MAKE_DIRECTORY ${headers})
foreach(library fmt stb nlohmann)
  if(NOT EXISTS /usr/include/${library})
    message(FATAL_ERROR "no ${library} in /usr/include: run scripts/install_packages.sh test")
  endif()
  file(CREATE_LINK /usr/include/${library} ${headers}/${library} SYMBOLIC)
endforeach()

set(src ${PROJECT_SOURCE_DIR}/src/burr)
file(GLOB render CONFIGURE_DEPENDS ${src}/render/*.cpp ${src}/render/gl/*.cpp)
# windows, headsets, files, threads, meshoptimizer: not in a page
list(FILTER render EXCLUDE REGEX
  "/(context|headset|x_errors|xr_binding|bone_scene|coarsening|coarse_mesh|picture)\\.cpp$")
set(phantom build shapes sculpt temporal_bone)
list(TRANSFORM phantom REPLACE "(.+)" "${src}/phantom/\\1.cpp")
set(hands ${PROJECT_SOURCE_DIR}/apps/burr/window/hands/mouse_aim.cpp ${PROJECT_SOURCE_DIR}/apps/burr/window/hands/mouse_hand.cpp
  ${PROJECT_SOURCE_DIR}/apps/burr/window/hands/grip.cpp)
set(record pen mcap/mcap_writer schema session_info view course grid_json tool_json identity private_text bone_blob
  player player_notes assumed_tool mcap/mcap_reader)
list(TRANSFORM record REPLACE "(.+)" "${src}/record/\\1.cpp")
list(APPEND record ${src}/sim/session_words.cpp ${src}/scenario/recipe.cpp ${src}/base/printable.cpp)
file(GLOB web CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/*.cpp)

add_library(burr_page_parts OBJECT ${render} ${phantom} ${record} ${hands} ${src}/workshop/work_view.cpp)
target_include_directories(burr_page_parts PUBLIC ${PROJECT_SOURCE_DIR}/web/gaps ${PROJECT_SOURCE_DIR}/apps/burr)
target_include_directories(burr_page_parts SYSTEM PUBLIC ${headers})
target_compile_definitions(burr_page_parts PUBLIC FMT_HEADER_ONLY)
target_compile_options(burr_page_parts PUBLIC "SHELL:-include ${PROJECT_SOURCE_DIR}/web/gaps/std_gaps.h")
target_link_libraries(burr_page_parts PUBLIC burr_core burr_options)

# what stands in place of sources of the rooms (*_web.cpp), and what JavaScript calls
add_executable(burr_page ${web})
target_include_directories(burr_page PRIVATE ${PROJECT_SOURCE_DIR}/web)
target_link_libraries(burr_page PRIVATE burr_page_parts)
set(site ${CMAKE_BINARY_DIR}/site)
set_target_properties(burr_page PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/web SUFFIX .mjs)
target_link_options(burr_page PRIVATE --no-entry -sMODULARIZE=1 -sEXPORT_ES6=1 -sENVIRONMENT=web,worker -sFORCE_FILESYSTEM=1
  -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=64MB -sMAXIMUM_MEMORY=2GB
  -sMIN_WEBGL_VERSION=2 -sMAX_WEBGL_VERSION=2
  -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=UTF8ToString,FS,WORKERFS -lworkerfs.js)

# the folder for a host: the module, the pages, the words
file(GLOB_RECURSE pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/pages/*)
file(GLOB word_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/words/*.toml ${PROJECT_SOURCE_DIR}/web/words/*.toml)
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)
add_custom_command(OUTPUT ${site}/words.json
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${site}
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${PROJECT_SOURCE_DIR}/web/pages ${site}
  COMMAND ${CMAKE_COMMAND} -E copy ${CMAKE_BINARY_DIR}/web/burr_page.mjs ${CMAKE_BINARY_DIR}/web/burr_page.wasm ${site}
  COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/web/words.py ${PROJECT_SOURCE_DIR} ${site}/words.json
  DEPENDS burr_page ${pages} ${word_files} ${PROJECT_SOURCE_DIR}/web/words.py COMMENT "The pages: ${site}" VERBATIM)
add_custom_target(site ALL DEPENDS ${site}/words.json)
