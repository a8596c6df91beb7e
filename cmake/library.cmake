# libburr: every room in one shared library. A new .cpp in a room is found automatically.
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

# ... and so does the table of materials
set(BURR_MATERIALS ${PROJECT_SOURCE_DIR}/materials/materials.toml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${BURR_MATERIALS})
file(READ ${BURR_MATERIALS} BURR_MATERIALS_TEXT)
configure_file(${PROJECT_SOURCE_DIR}/cmake/built_in_materials.cpp.in ${CMAKE_BINARY_DIR}/built_in_materials.cpp @ONLY)
list(APPEND BURR_SOURCES ${CMAKE_BINARY_DIR}/built_in_materials.cpp)

set(library_sources ${BURR_SOURCES})
list(REMOVE_ITEM library_sources ${BURR_READERS})
list(APPEND library_sources ${PROJECT_SOURCE_DIR}/third_party/safe_toml.cpp)
add_library(burr SHARED ${library_sources})
add_dependencies(burr burr_read burr_guard)  # without them no scan can be read, and no arm guarded
add_library(burr::burr ALIAS burr)
set_target_properties(burr PROPERTIES OUTPUT_NAME burr VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
target_include_directories(burr PUBLIC
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_include_directories(burr PRIVATE ${PROJECT_SOURCE_DIR}/third_party)
target_compile_features(burr PUBLIC cxx_std_20)
target_link_libraries(burr PUBLIC Eigen3::Eigen Threads::Threads)
target_link_libraries(burr PRIVATE $<BUILD_INTERFACE:burr_options> fmt::fmt ZLIB::ZLIB BZip2::BZip2
  PkgConfig::ZSTD
  PkgConfig::EPOXY PkgConfig::SDL2 nlohmann_json::nlohmann_json spdlog::spdlog meshoptimizer::meshoptimizer
  $<BUILD_INTERFACE:burr_crtk>)
target_compile_definitions(burr PRIVATE BURR_VERSION="${PROJECT_VERSION}"
  BURR_LIBEXEC_FROM_LIB="${BURR_LIBEXEC_FROM_LIB}")
target_link_libraries(burr PRIVATE ${CMAKE_DL_LIBS})
burr_common_headers(burr <fmt/format.h>)

set(reading ${BURR_SOURCES} ${PROJECT_SOURCE_DIR}/third_party/safe_toml.cpp)
list(FILTER reading INCLUDE REGEX "/(base|io|importing|record|scenario|fit|third_party)/|/surgeon/motion[.]cpp$|/sim/(replay|session_words)[.]cpp$|/device/(haply/message|polhem/line)[.]cpp$")
burr_reads_files(${reading})

# Kernels are compiled once per instruction set, from one source, and chosen at run time; the bits
# are the same.
foreach(source ${BURR_SOURCES})
  if(source MATCHES "_(avx2|avx512|scalar)\\.cpp$")
    set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)  # other options,
                                                                                  # other headers
  endif()
  if(source MATCHES "_avx2\\.cpp$")
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "-mavx2;-O3")
  elseif(source MATCHES "_avx512\\.cpp$")
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS
      "-mavx512f;-mavx512bw;-mavx512vl;-mavx512dq;-mprefer-vector-width=512;-O3")
  elseif(source MATCHES "_scalar\\.cpp$")
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "-O3")
  endif()
endforeach()

# the sources that shape the built-in bones (program.cmake)
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
