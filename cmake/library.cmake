# libburr: every room. A new .cpp in a room is found by itself.
file(GLOB_RECURSE BURR_SOURCES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/burr/*.cpp)
file(GLOB_RECURSE BURR_HEADERS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/burr/*.h)

# the built-in cases become part of the library, so they are found wherever it is installed
file(GLOB BURR_CASES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cases/*.toml)
set(BURR_CASE_TEXTS "")
foreach(case ${BURR_CASES})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${case})
  get_filename_component(name ${case} NAME_WE)
  string(REPLACE "_" "-" name ${name})
  file(READ ${case} text)
  string(APPEND BURR_CASE_TEXTS "    {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/cmake/built_in_cases.cpp.in ${CMAKE_BINARY_DIR}/built_in_cases.cpp @ONLY)
list(APPEND BURR_SOURCES ${CMAKE_BINARY_DIR}/built_in_cases.cpp)

# ... so do the built-in rubrics
file(GLOB BURR_RUBRICS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/rubrics/*.toml)
set(BURR_RUBRIC_TEXTS "")
foreach(rubric ${BURR_RUBRICS})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${rubric})
  get_filename_component(name ${rubric} NAME_WE)
  string(REPLACE "_" "-" name ${name})
  file(READ ${rubric} text)
  string(APPEND BURR_RUBRIC_TEXTS "    {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/cmake/built_in_rubrics.cpp.in ${CMAKE_BINARY_DIR}/built_in_rubrics.cpp @ONLY)
list(APPEND BURR_SOURCES ${CMAKE_BINARY_DIR}/built_in_rubrics.cpp)

# ... and so does the table of materials
set(BURR_MATERIALS ${PROJECT_SOURCE_DIR}/materials/materials.toml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${BURR_MATERIALS})
file(READ ${BURR_MATERIALS} BURR_MATERIALS_TEXT)
configure_file(${PROJECT_SOURCE_DIR}/cmake/built_in_materials.cpp.in ${CMAKE_BINARY_DIR}/built_in_materials.cpp @ONLY)
list(APPEND BURR_SOURCES ${CMAKE_BINARY_DIR}/built_in_materials.cpp)

# ... and the tools
set(BURR_TOOLS ${PROJECT_SOURCE_DIR}/tools/tools.toml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${BURR_TOOLS})
file(READ ${BURR_TOOLS} BURR_TOOLS_TEXT)
configure_file(${PROJECT_SOURCE_DIR}/cmake/built_in_tools.cpp.in ${CMAKE_BINARY_DIR}/built_in_tools.cpp @ONLY)
list(APPEND BURR_SOURCES ${CMAKE_BINARY_DIR}/built_in_tools.cpp)

# The library in parts, by what they need. Each part is compiled once; libburr.so is their sum.
#
#     burr_core          Eigen                                    a library of its own, libburr_core.so (core.cmake)
#     burr_files         + zlib, bzip2, zstd, JSON, TOML, fmt     reads and writes scans, meshes, cases, recordings
#     burr_session       + threads that go first                  a session by the clock, hands, experiments
#     burr_render_gl     + OpenGL, SDL, OpenXR                    pictures
#     burr_sound         + SDL                                    sound
#     burr_device_...    + what its maker gives                   one each
#     burr_workshop      + all of these, OpenSSL's hashes                        opens things: bone, place, hand, recorder, live surface
#     burr_front         + nothing                                what a window and a page say and show: words, guidance, report, the mouse
#
# burr_part(NAME WITH TARGET... FROM GLOB...): the sources that match; each belongs to one part.
set(rest ${BURR_SOURCES})
list(REMOVE_ITEM rest ${BURR_READERS} ${BURR_SEG_SOURCES} ${BURR_CORE_SOURCES})
list(FILTER rest EXCLUDE REGEX "_(plain|windows)\\.cpp$")
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  list(FILTER rest EXCLUDE REGEX "_avx(2|512)\\.cpp$")
endif()
set(BURR_PARTS "")
function(burr_part name)
  cmake_parse_arguments(part "" "" "WITH;FROM;MORE" ${ARGN})
  list(TRANSFORM part_FROM PREPEND "/src/burr/")
  list(JOIN part_FROM "|" pattern)
  set(mine ${rest})
  list(FILTER mine INCLUDE REGEX "${pattern}")
  list(REMOVE_ITEM rest ${mine})
  add_library(${name} OBJECT ${mine} ${part_MORE})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/third_party)
  target_link_libraries(${name} PUBLIC burr_core PRIVATE burr_options fmt::fmt ${part_WITH})
  burr_kernels(${mine})
  set(rest ${rest} PARENT_SCOPE)
  set(BURR_PARTS ${BURR_PARTS} ${name} PARENT_SCOPE)
endfunction()
foreach(vendor crtk forcedimension haply openhaptics polhem)
  set(needs ${CMAKE_DL_LIBS})
  if(vendor STREQUAL "crtk")
    list(APPEND needs burr_crtk)
  elseif(vendor STREQUAL "haply")
    list(APPEND needs nlohmann_json::nlohmann_json)
  endif()
  set(speaks "")
  if(vendor STREQUAL "haply")
    set(speaks net/web_socket)
  endif()
  burr_part(burr_device_${vendor} FROM device/${vendor}/ ${speaks} WITH ${needs})
endforeach()
# X11's headers define Status, None and other names as macros: what follows them in one unit would not compile
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/burr/render/gl/x_errors.cpp ${PROJECT_SOURCE_DIR}/src/burr/render/gl/xr_binding.cpp
  PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
burr_part(burr_render_gl FROM render/ WITH PkgConfig::EPOXY PkgConfig::SDL2 meshoptimizer::meshoptimizer ${CMAKE_DL_LIBS})
burr_part(burr_sound FROM sound/ WITH PkgConfig::SDL2 ${CMAKE_DL_LIBS})
burr_part(burr_workshop FROM workshop/ WITH OpenSSL::Crypto ${CMAKE_DL_LIBS})
include(${PROJECT_SOURCE_DIR}/cmake/words.cmake)
burr_part(burr_front FROM words/ guidance/ report/ mouse/ MORE ${CMAKE_BINARY_DIR}/words/word_texts.cpp
  WITH nlohmann_json::nlohmann_json)
target_include_directories(burr_front PRIVATE ${CMAKE_BINARY_DIR}/words)  # the keys
burr_part(burr_session FROM device/ people/ fit/ metrics/ scoring/ surgeon/ sim/
  MORE ${CMAKE_BINARY_DIR}/built_in_rubrics.cpp WITH ${CMAKE_DL_LIBS})
burr_part(burr_files FROM base/ io/ importing/ scenario/ phantom/ record/
  MORE ${CMAKE_BINARY_DIR}/built_in_cases.cpp ${CMAKE_BINARY_DIR}/built_in_materials.cpp ${CMAKE_BINARY_DIR}/built_in_tools.cpp
    ${PROJECT_SOURCE_DIR}/third_party/safe_toml.cpp
  WITH ZLIB::ZLIB BZip2::BZip2 PkgConfig::ZSTD nlohmann_json::nlohmann_json ${CMAKE_DL_LIBS})
# The web server and what asks other servers are for the program alone: who cuts bone with libburr.so loads no TLS.
set(net_sources ${rest})
list(FILTER net_sources INCLUDE REGEX "/src/burr/net/")
list(REMOVE_ITEM rest ${net_sources})
# So is what sends statements.
set(lrs_sources ${rest})
list(FILTER lrs_sources INCLUDE REGEX "/src/burr/lrs/")
list(REMOVE_ITEM rest ${lrs_sources})
# The store of learners is for the program alone: who cuts bone with libburr.so loads no database.
set(school_sources ${rest})
list(FILTER school_sources INCLUDE REGEX "/src/burr/school/")
if(school_sources)
  list(REMOVE_ITEM rest ${school_sources})
endif()
# So is the writer of data sets: who cuts bone with libburr.so loads no HDF5.
set(dataset_sources ${rest})
list(FILTER dataset_sources INCLUDE REGEX "/src/burr/dataset/")
list(REMOVE_ITEM rest ${dataset_sources})
# So is what asks whether scores are right.
set(proof_sources ${rest})
list(FILTER proof_sources INCLUDE REGEX "/src/burr/proof/")
list(REMOVE_ITEM rest ${proof_sources})
set(known ${CMAKE_BINARY_DIR}/built_in_cases.cpp ${CMAKE_BINARY_DIR}/built_in_materials.cpp
  ${CMAKE_BINARY_DIR}/built_in_rubrics.cpp ${CMAKE_BINARY_DIR}/built_in_tools.cpp)
list(REMOVE_ITEM rest ${known})
if(rest)
  message(FATAL_ERROR "in no part of the library (cmake/library.cmake): ${rest}")
endif()
set_property(SOURCE ${PROJECT_SOURCE_DIR}/src/burr/base/helper_program.cpp APPEND PROPERTY
  COMPILE_DEFINITIONS BURR_LIBEXEC_FROM_LIB="${BURR_LIBEXEC_FROM_LIB}")
burr_common_headers(burr_files <fmt/format.h>)
foreach(part burr_render_gl burr_workshop burr_front burr_device_haply)
  burr_glue_for_asan(${part})
endforeach()
foreach(part burr_session burr_device_crtk burr_device_forcedimension burr_device_openhaptics burr_device_polhem)
  burr_common_headers(${part} REUSE_FROM burr_files)  # the same options, so one set of headers for all
endforeach()
burr_common_headers(burr_render_gl <fmt/format.h>)
burr_common_headers(burr_front <fmt/format.h> <nlohmann/json.hpp>)
foreach(part burr_workshop burr_device_haply)
  if(BURR_SANITIZE MATCHES "address")  # other options
    burr_common_headers(${part} <fmt/format.h>)
  else()
    burr_common_headers(${part} REUSE_FROM burr_files)
  endif()
endforeach()

add_library(burr SHARED)
target_link_libraries(burr PUBLIC burr_core PRIVATE $<BUILD_INTERFACE:burr_options>)
target_include_directories(burr PUBLIC $<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/words>)  # the keys of the room `words`
foreach(part ${BURR_PARTS})
  target_link_libraries(burr PRIVATE $<BUILD_INTERFACE:${part}>)
endforeach()
if(NOT BURR_WARNINGS_ONLY)  # nothing runs with that build's library
  add_dependencies(burr burr_guard)  # without it no arm is guarded
  if(BURR_READER)
    add_dependencies(burr burr_read burr_seg)  # without them no scan can be read, and no DICOM written
  endif()
endif()
add_library(burr::burr ALIAS burr)
set_target_properties(burr PROPERTIES OUTPUT_NAME burr VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}
  LINKER_LANGUAGE CXX INSTALL_RPATH "$ORIGIN")  # it finds libburr_core.so beside itself

set(reading ${BURR_SOURCES} ${PROJECT_SOURCE_DIR}/third_party/safe_toml.cpp)
list(FILTER reading INCLUDE REGEX "/(base|io|importing|record|scenario|fit|third_party)/|/workshop/device_book[.]cpp$|/surgeon/motion[.]cpp$|/scoring/rubric[.]cpp$|/sim/(replay|session_words)[.]cpp$|/device/(haply/message|polhem/line)[.]cpp$")
burr_reads_files(${reading})

add_library(burr_net STATIC ${net_sources})
target_link_libraries(burr_net PUBLIC burr PRIVATE burr_options fmt::fmt nlohmann_json::nlohmann_json OpenSSL::SSL)
add_library(burr_school STATIC ${school_sources})
target_link_libraries(burr_school PUBLIC burr PRIVATE burr_options fmt::fmt nlohmann_json::nlohmann_json
  PkgConfig::SQLITE PkgConfig::POSTGRES OpenSSL::Crypto)
add_library(burr_lrs STATIC ${lrs_sources})
target_link_libraries(burr_lrs PUBLIC burr_school burr_net PRIVATE burr burr_options fmt::fmt nlohmann_json::nlohmann_json)
burr_common_headers(burr_school <fmt/format.h>)
add_library(burr_dataset STATIC ${dataset_sources})
target_link_libraries(burr_dataset PUBLIC burr PRIVATE burr_options fmt::fmt PkgConfig::HDF5)
burr_common_headers(burr_dataset <fmt/format.h>)
# with the tables of known bones
file(GLOB BURR_TABLES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/burr/proof/tables/*.txt)
set(BURR_TABLE_TEXTS "")
foreach(table ${BURR_TABLES})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${table})
  get_filename_component(name ${table} NAME_WE)
  string(REPLACE "_" "-" name ${name})
  file(READ ${table} text)
  string(REPLACE ";" "@SEMICOLON@" text "${text}")
  string(APPEND BURR_TABLE_TEXTS "    {\"${name}\", R\"table(${text})table\"},\n")
endforeach()
string(REPLACE "@SEMICOLON@" ";" BURR_TABLE_TEXTS "${BURR_TABLE_TEXTS}")
configure_file(${PROJECT_SOURCE_DIR}/cmake/built_in_tables.cpp.in ${CMAKE_BINARY_DIR}/built_in_tables.cpp @ONLY)
add_library(burr_proof STATIC ${proof_sources} ${CMAKE_BINARY_DIR}/built_in_tables.cpp)
target_link_libraries(burr_proof PUBLIC burr PRIVATE burr_options fmt::fmt)
burr_common_headers(burr_proof <fmt/format.h>)
foreach(part burr_net burr_school burr_lrs)
  burr_glue_for_asan(${part})
endforeach()

# what the built-in bones are shaped by (program.cmake)
file(GLOB BURR_PHANTOMS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/burr/phantom/*)

# hands and bones with known answers: for the program, tests, benches and samples
file(GLOB BURR_SCENES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/*.cpp)
if(BURR_SCENES)
  add_library(burr_scenes STATIC ${BURR_SCENES})
  target_include_directories(burr_scenes PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(burr_scenes PUBLIC burr PRIVATE burr_options)
  burr_common_headers(burr_scenes)
else()
  add_library(burr_scenes INTERFACE)
  target_include_directories(burr_scenes INTERFACE ${PROJECT_SOURCE_DIR})
  target_link_libraries(burr_scenes INTERFACE burr)
endif()
