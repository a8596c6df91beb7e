# The page: burr in a browser. Everything that only a browser has lies here; the rooms of src/burr are compiled as they are.
#
#     cmake --preset web && cmake --build --preset web        -> build/web/published, a folder for any static host (scripts/build_page.sh)
#
# One WebAssembly module, burr_page, is loaded twice: in the page, where it draws, and in a worker, where it ticks. What is not needed for
# the first cut is in modules of its own. No JavaScript that emscripten writes makes code of text: the page's policy forbids it.
add_link_options(-sDYNAMIC_EXECUTION=0)

# header-only libraries of this machine, alone: beside them in /usr/include lie the headers of another C library
set(headers ${CMAKE_BINARY_DIR}/web/headers)
file(MAKE_DIRECTORY ${headers})
foreach(library fmt stb nlohmann toml++)
  if(NOT EXISTS /usr/include/${library})
    message(FATAL_ERROR "no ${library} in /usr/include: run scripts/install_packages.sh test")
  endif()
  file(CREATE_LINK /usr/include/${library} ${headers}/${library} SYMBOLIC)
endforeach()

set(src ${PROJECT_SOURCE_DIR}/src/burr)
file(GLOB render CONFIGURE_DEPENDS ${src}/render/*.cpp ${src}/render/gl/*.cpp)
# windows, headsets, files, threads, meshoptimizer: not in a page
list(FILTER render EXCLUDE REGEX
  "/(context|headset|headset_start|x_errors|xr_binding|bone_scene|coarsening|coarse_mesh|picture)\\.cpp$")
set(phantom build shapes sculpt temporal_bone temporal_bone_model)
list(TRANSFORM phantom REPLACE "(.+)" "${src}/phantom/\\1.cpp")
file(GLOB mouse CONFIGURE_DEPENDS ${src}/mouse/*.cpp)
set(record pen text_sums file_lock mcap/mcap_writer mcap/mcap_copy schema protobuf tick_columns bricks command_json session_schema session_info view course grid_json tool_json identity private_text bone_blob)
set(reading chain player player_bone player_notes player_texts assumed_tool mcap/mcap_reader mcap/mcap_scan mcap/mcap_summary mcap/lz4_frame)
foreach(list record reading)
  list(TRANSFORM ${list} REPLACE "(.+)" "${src}/record/\\1.cpp")
endforeach()
list(APPEND record ${src}/sim/session_words.cpp ${src}/scenario/recipe.cpp ${src}/scenario/case_text.cpp
  ${src}/workshop/spared.cpp ${src}/base/printable.cpp ${src}/base/plain_file.cpp ${src}/base/disk_words.cpp ${src}/base/handle.cpp)
file(GLOB web CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/*.cpp)
list(FILTER web EXCLUDE REGEX "/whole_chunks_web\\.cpp$")

# burr_web_parts(NAME SOURCE...): sources of the rooms, compiled as they are
function(burr_web_parts name)
  add_library(${name} OBJECT ${ARGN})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR}/web/gaps)
  target_include_directories(${name} SYSTEM PUBLIC ${headers})
  target_compile_definitions(${name} PUBLIC FMT_HEADER_ONLY)
  target_compile_options(${name} PUBLIC "SHELL:-include ${PROJECT_SOURCE_DIR}/web/gaps/std_gaps.h")
  target_link_libraries(${name} PUBLIC burr_core burr_options)
endfunction()
burr_web_parts(burr_record_parts ${record})
burr_web_parts(burr_reading_parts ${reading})
burr_web_parts(burr_phantom_parts ${phantom})  # who opens the page waits for the bone: made for speed, not for size
target_compile_options(burr_record_parts PRIVATE -Oz)
target_compile_options(burr_reading_parts PRIVATE -Os)
# What no session of the page runs: tools that are no balls, two hands, other methods of touch, pieces, the mirror.
file(GLOB idle ${src}/haptics/six/*.cpp ${src}/haptics/baselines/*.cpp ${src}/edit/piece_*.cpp)
list(FILTER idle EXCLUDE REGEX "_(scalar|avx2|avx512)\\.cpp$")
list(APPEND idle ${src}/edit/tool_body.cpp ${src}/edit/mirror.cpp ${src}/edit/brush.cpp ${src}/tick/second_hand.cpp
  ${src}/tick/held_piece.cpp ${src}/tick/mirror_plane.cpp ${src}/tick/shaped_cutting.cpp ${src}/tool/shape_grid.cpp
  ${src}/tool/grid_of_mesh.cpp ${src}/tool/tool.cpp)
set_source_files_properties(${idle} PROPERTIES COMPILE_OPTIONS "-Oz")
burr_web_parts(burr_page_parts ${render} ${mouse} ${src}/workshop/work_view.cpp ${src}/workshop/piece_look.cpp)
target_compile_options(burr_page_parts PRIVATE -Oz)

# what stands in place of sources of the rooms (*_web.cpp), and what JavaScript calls
add_executable(burr_page ${web})
target_include_directories(burr_page PRIVATE ${PROJECT_SOURCE_DIR}/web)
target_link_libraries(burr_page PRIVATE burr_page_parts burr_record_parts burr_phantom_parts)
set(site ${CMAKE_BINARY_DIR}/site)
set_target_properties(burr_page PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/web SUFFIX .mjs)
target_link_options(burr_page PRIVATE --no-entry -sMODULARIZE=1 -sEXPORT_ES6=1 -sENVIRONMENT=web,worker -sFORCE_FILESYSTEM=1
  -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=64MB -sMAXIMUM_MEMORY=2GB
  -sMIN_WEBGL_VERSION=2 -sMAX_WEBGL_VERSION=2
  -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=UTF8ToString,FS)

# The module of the page "replay", burr_replay: reads recordings. Who mills does not wait for it.
set(web_dir ${PROJECT_SOURCE_DIR}/web)
add_executable(burr_replay ${web_dir}/replay/replay_api.cpp ${web_dir}/bone_api.cpp ${web_dir}/crc32_web.cpp ${web_dir}/packed_web.cpp
  ${web_dir}/whole_chunks_web.cpp ${web_dir}/no_cases_web.cpp ${web_dir}/coarse_mesh_web.cpp
  ${src}/render/soft_scene.cpp ${src}/render/skin_mesh.cpp ${src}/render/tool_mesh.cpp ${src}/workshop/out_piece.cpp
  ${src}/workshop/piece_look.cpp ${src}/workshop/tool_looks.cpp)
target_include_directories(burr_replay PRIVATE ${web_dir})
target_link_libraries(burr_replay PRIVATE burr_record_parts burr_reading_parts burr_phantom_parts)
set_target_properties(burr_replay PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/web SUFFIX .mjs)
target_link_options(burr_replay PRIVATE --no-entry -sMODULARIZE=1 -sEXPORT_ES6=1 -sENVIRONMENT=web,worker -sFORCE_FILESYSTEM=1
  -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=64MB -sMAXIMUM_MEMORY=2GB
  -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=UTF8ToString,FS,WORKERFS -lworkerfs.js)

# The second module, burr_score: the steps of the case, its score and the report. It is loaded when the first cut is possible,
# so that nobody waits for it. Its texts: the cases, their rubrics, the tools, the words of the window.
include(${PROJECT_SOURCE_DIR}/cmake/words.cmake)
function(burr_text variable name file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  set(${variable} "    {\"${name}\", R\"toml(${text})toml\"},\n" PARENT_SCOPE)
endfunction()
set(BURR_CASE_TEXTS "")
set(BURR_RUBRIC_TEXTS "")
foreach(file temporal_bone jaw spine tooth block)
  string(REPLACE _ - name ${file})
  burr_text(case_text ${name} ${PROJECT_SOURCE_DIR}/cases/${file}.toml)
  burr_text(rubric_text ${name} ${PROJECT_SOURCE_DIR}/rubrics/${file}.toml)
  string(APPEND BURR_CASE_TEXTS "${case_text}")
  string(APPEND BURR_RUBRIC_TEXTS "${rubric_text}")
endforeach()
file(READ ${PROJECT_SOURCE_DIR}/tools/tools.toml BURR_TOOLS_TEXT)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/tools.toml)
foreach(texts cases rubrics tools)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/built_in_${texts}.cpp.in ${CMAKE_BINARY_DIR}/built_in_${texts}.cpp @ONLY)
endforeach()
file(GLOB score CONFIGURE_DEPENDS ${src}/scoring/*.cpp ${src}/metrics/*.cpp ${src}/scenario/*.cpp ${src}/report/*.cpp
  ${src}/words/*.cpp ${src}/guidance/*.cpp)
list(FILTER score EXCLUDE REGEX "/(report_pictures|step_watch|recipe|case_text|write_case)\\.cpp$")
file(GLOB bones CONFIGURE_DEPENDS ${src}/phantom/*.cpp)
list(REMOVE_ITEM bones ${phantom})
burr_web_parts(burr_bones_parts ${bones})
target_compile_options(burr_bones_parts PRIVATE -Os)
burr_web_parts(burr_score_parts ${score} ${src}/workshop/label_check.cpp ${src}/workshop/allowed.cpp
  ${src}/workshop/piece_plan.cpp ${src}/sim/move_pieces.cpp ${src}/base/text_file.cpp ${src}/base/markup.cpp
  ${src}/base/base64.cpp ${src}/workshop/spared_distance.cpp
  ${PROJECT_SOURCE_DIR}/third_party/safe_toml.cpp ${CMAKE_BINARY_DIR}/words/word_texts.cpp
  ${CMAKE_BINARY_DIR}/built_in_cases.cpp ${CMAKE_BINARY_DIR}/built_in_rubrics.cpp ${CMAKE_BINARY_DIR}/built_in_tools.cpp)
target_compile_options(burr_score_parts PRIVATE -Os)
target_include_directories(burr_score_parts PRIVATE ${CMAKE_BINARY_DIR}/words ${PROJECT_SOURCE_DIR}/third_party)
file(GLOB score_api CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/score/*.cpp)
add_executable(burr_score ${score_api} ${web_dir}/crc32_web.cpp ${web_dir}/packed_web.cpp
  ${web_dir}/whole_chunks_web.cpp)
target_include_directories(burr_score PRIVATE ${web_dir} ${CMAKE_BINARY_DIR}/words ${PROJECT_SOURCE_DIR}/third_party)
target_link_libraries(burr_score PRIVATE burr_score_parts burr_bones_parts burr_record_parts burr_reading_parts burr_phantom_parts)
set_target_properties(burr_score PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/web SUFFIX .mjs)
target_link_options(burr_score PRIVATE --no-entry -sMODULARIZE=1 -sEXPORT_ES6=1 -sENVIRONMENT=worker -sFORCE_FILESYSTEM=1
  -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=64MB -sMAXIMUM_MEMORY=4GB
  -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=UTF8ToString,FS,WORKERFS -lworkerfs.js)

# The third module, burr_sound: a sound thread loads nothing and has no JavaScript of emscripten's.
add_executable(burr_sound ${web_dir}/sound/sound_api.cpp ${src}/sound/synth.cpp ${src}/workshop/sound_tracker.cpp)
target_compile_options(burr_sound PRIVATE "SHELL:-include ${PROJECT_SOURCE_DIR}/web/gaps/std_gaps.h")
target_link_libraries(burr_sound PRIVATE burr_core burr_options)
set_target_properties(burr_sound PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/web SUFFIX .wasm)
target_link_options(burr_sound PRIVATE --no-entry -sSTANDALONE_WASM=1 -sINITIAL_MEMORY=8MB)

# The fourth module, burr_import, loaded only when somebody opens a scan: burr's readers without what needs libraries that Debian does
# not have for WebAssembly (web/import/gaps), and the making of bone.
file(GLOB readers CONFIGURE_DEPENDS ${src}/io/read/*.cpp ${src}/importing/*.cpp)
list(FILTER readers EXCLUDE REGEX "/(png|tiff|grey_picture|picture_scale|picture_stack|stack_names|read_adf|yaml|read_scan)\\.cpp$|_avx(2|512)\\.cpp$")
list(FILTER readers EXCLUDE REGEX "/(read_mesh|read_mesh_unfenced|mesh_builder|mesh_text|polygon|ply_header|read_(stl|obj|ply))\\.cpp$")  # of tools
file(GLOB import_api CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/import/*.cpp)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/materials/materials.toml)
file(READ ${PROJECT_SOURCE_DIR}/materials/materials.toml BURR_MATERIALS_TEXT)
configure_file(${PROJECT_SOURCE_DIR}/cmake/built_in_materials.cpp.in ${CMAKE_BINARY_DIR}/built_in_materials.cpp @ONLY)
add_executable(burr_import ${import_api} ${readers} ${src}/io/voxels.cpp ${src}/io/value_groups.cpp ${src}/base/printable.cpp
  ${src}/base/text_file.cpp ${src}/base/plain_file.cpp ${src}/base/handle.cpp ${src}/scenario/recipe.cpp ${src}/record/bone_blob.cpp ${src}/record/grid_json.cpp
  ${PROJECT_SOURCE_DIR}/third_party/safe_toml.cpp ${CMAKE_BINARY_DIR}/built_in_materials.cpp
  ${PROJECT_SOURCE_DIR}/web/crc32_web.cpp ${PROJECT_SOURCE_DIR}/web/packed_web.cpp)
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)
include(${PROJECT_SOURCE_DIR}/cmake/letters.cmake)
target_include_directories(burr_import PRIVATE ${BURR_LETTERS} ${PROJECT_SOURCE_DIR}/web ${PROJECT_SOURCE_DIR}/web/import
  ${PROJECT_SOURCE_DIR}/web/import/gaps ${PROJECT_SOURCE_DIR}/web/gaps ${PROJECT_SOURCE_DIR}/third_party)
target_include_directories(burr_import SYSTEM PRIVATE ${headers})
target_compile_definitions(burr_import PRIVATE FMT_HEADER_ONLY)
target_compile_options(burr_import PRIVATE "SHELL:-include ${PROJECT_SOURCE_DIR}/web/gaps/std_gaps.h"
  "SHELL:-include ${PROJECT_SOURCE_DIR}/web/import/gaps/import_gaps.h")
target_link_libraries(burr_import PRIVATE burr_core burr_options)
set_target_properties(burr_import PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/web SUFFIX .mjs)
target_link_options(burr_import PRIVATE --no-entry -sMODULARIZE=1 -sEXPORT_ES6=1 -sENVIRONMENT=worker -sFORCE_FILESYSTEM=1
  -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=64MB -sMAXIMUM_MEMORY=2GB
  -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=UTF8ToString,FS,WORKERFS -lworkerfs.js)

# The npm package burr-core: bones, sessions tick by tick, recordings, for other people's pages and for Node. It is packed, not published.
# Not for "node": Debian's emscripten writes `require` for it into modules that have none, and npm/index.mjs reads the files itself.
add_executable(burr_npm ${web_dir}/npm/npm_api.cpp ${web_dir}/page_recorder.cpp ${web_dir}/no_cases_web.cpp ${web_dir}/crc32_web.cpp ${web_dir}/packed_web.cpp)
target_include_directories(burr_npm PRIVATE ${web_dir})
target_link_libraries(burr_npm PRIVATE burr_bones_parts burr_record_parts burr_phantom_parts)
set_target_properties(burr_npm PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/web SUFFIX .mjs OUTPUT_NAME burr_core)
target_link_options(burr_npm PRIVATE --no-entry -sMODULARIZE=1 -sEXPORT_ES6=1 -sENVIRONMENT=web,worker -sFORCE_FILESYSTEM=1
  -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=64MB -sMAXIMUM_MEMORY=4GB
  -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=UTF8ToString,FS)

# Codecs of others, from npm, as web/package-lock.json names them: fetched once, kept in the folder of the build.
set(codecs ${CMAKE_BINARY_DIR}/web/codecs)
add_custom_command(OUTPUT ${codecs}/licences.txt
  COMMAND Python3::Interpreter ${web_dir}/codecs/take.py ${CMAKE_BINARY_DIR}/web/npm ${codecs}
  DEPENDS ${web_dir}/codecs/take.py ${web_dir}/package.json ${web_dir}/package-lock.json ${PROJECT_SOURCE_DIR}/packaging/copyright
  COMMENT "Codecs of others: ${codecs}" VERBATIM)

# the folder for a host: the module, the pages, the words, the codecs
file(GLOB_RECURSE pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/pages/*)
file(GLOB word_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/words/*.toml ${PROJECT_SOURCE_DIR}/web/words/*.toml)
add_custom_command(OUTPUT ${site}/words/en.json
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${site}
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${PROJECT_SOURCE_DIR}/web/pages ${site}
  COMMAND ${CMAKE_COMMAND} -E copy ${CMAKE_BINARY_DIR}/web/burr_page.mjs ${CMAKE_BINARY_DIR}/web/burr_page.wasm
    ${CMAKE_BINARY_DIR}/web/burr_score.mjs ${CMAKE_BINARY_DIR}/web/burr_score.wasm
    ${CMAKE_BINARY_DIR}/web/burr_sound.wasm ${CMAKE_BINARY_DIR}/web/burr_replay.mjs ${CMAKE_BINARY_DIR}/web/burr_replay.wasm
    ${CMAKE_BINARY_DIR}/web/burr_import.mjs ${CMAKE_BINARY_DIR}/web/burr_import.wasm ${site}
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${codecs} ${site}/codecs
  COMMAND Python3::Interpreter ${web_dir}/case.py ${PROJECT_SOURCE_DIR}/cases/temporal_bone.toml
    ${PROJECT_SOURCE_DIR}/rubrics/temporal_bone.toml ${site}/case.json
  COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/web/words.py ${PROJECT_SOURCE_DIR} ${site}
  DEPENDS burr_page burr_score burr_sound burr_import burr_replay ${codecs}/licences.txt ${pages} ${word_files} ${PROJECT_SOURCE_DIR}/web/words.py ${web_dir}/case.py COMMENT "The pages: ${site}" VERBATIM)

# as it is shipped: parts in a folder that their hash names, packed, with the files that hosts read
set(published ${CMAKE_BINARY_DIR}/published)
file(GLOB publishing CONFIGURE_DEPENDS ${web_dir}/publish/*)
add_custom_command(OUTPUT ${published}/version.json
  COMMAND Python3::Interpreter -B ${web_dir}/publish/publish.py ${site} ${published} ${PROJECT_VERSION}
  DEPENDS ${site}/words/en.json ${publishing} COMMENT "The page for hosts: ${published}" VERBATIM)
add_custom_target(site ALL DEPENDS ${published}/version.json)

# the same as a course of a learning management system
set(course ${CMAKE_BINARY_DIR}/burr-cmi5.zip)
file(GLOB course_files CONFIGURE_DEPENDS ${web_dir}/cmi5/* ${PROJECT_SOURCE_DIR}/cases/*.toml)
add_custom_command(OUTPUT ${course}
  COMMAND Python3::Interpreter -B ${web_dir}/publish/cmi5.py ${PROJECT_SOURCE_DIR} ${published} ${course}
  DEPENDS ${published}/version.json ${course_files} ${publishing} COMMENT "The course for cmi5: ${course}" VERBATIM)
add_custom_target(course ALL DEPENDS ${course})

# the package as `npm install` takes it
set(package ${CMAKE_BINARY_DIR}/burr-core)
file(GLOB_RECURSE package_files CONFIGURE_DEPENDS ${web_dir}/npm/*)
add_custom_command(OUTPUT ${package}/package.json
  COMMAND Python3::Interpreter -B ${web_dir}/npm/pack.py ${CMAKE_BINARY_DIR}/web ${package} ${PROJECT_VERSION}
  DEPENDS burr_npm ${codecs}/licences.txt ${package_files} ${web_dir}/pages/common/zstd.mjs ${PROJECT_SOURCE_DIR}/LICENSE COMMENT "The npm package: ${package}" VERBATIM)
add_custom_target(npm ALL DEPENDS ${package}/package.json)
