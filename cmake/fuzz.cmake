# fuzz/x_fuzz.cpp -> fuzz_x, one small program per reader that looks for inputs it cannot bear, and
# fuzz_seeds, which makes inputs to begin with. docs/fuzzing.md. Only in the preset `fuzz`.
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "BURR_FUZZ needs clang++ (libFuzzer): cmake --preset fuzz")
endif()

# the readers and what a replay needs; no pictures, no meshes
set(fuzzed_sources ${BURR_SOURCES})
list(FILTER fuzzed_sources EXCLUDE REGEX "/src/burr/(render|surface)/|/io/(write_3mf|write_glb|write_mesh|export_part)\\.cpp$")

add_library(burr_fuzzed STATIC EXCLUDE_FROM_ALL ${fuzzed_sources} ${PROJECT_SOURCE_DIR}/fuzz/support.cpp)
target_include_directories(burr_fuzzed PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/fuzz)
# not only what is undefined: a number that does not fit where it is put is a mistake as well
target_compile_options(burr_fuzzed PUBLIC
  -fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow -fno-sanitize-recover=all
  -fno-omit-frame-pointer)
target_link_options(burr_fuzzed PUBLIC -fsanitize=address,undefined,float-cast-overflow)
target_compile_definitions(burr_fuzzed PRIVATE BURR_VERSION="${PROJECT_VERSION}" TOML_HEADER_ONLY=1 BURR_SANITIZED=1)
target_link_libraries(burr_fuzzed PUBLIC Eigen3::Eigen Threads::Threads burr_options fmt::fmt ZLIB::ZLIB BZip2::BZip2
  burr_gdcm PkgConfig::ZSTD nlohmann_json::nlohmann_json)

add_custom_target(fuzzers)
file(GLOB fuzz_targets CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/fuzz/*_fuzz.cpp)
foreach(source ${fuzz_targets})
  get_filename_component(name ${source} NAME_WE)
  string(REGEX REPLACE "(.*)_fuzz$" "fuzz_\\1" name ${name})
  add_executable(${name} EXCLUDE_FROM_ALL ${source})
  target_link_libraries(${name} PRIVATE burr_fuzzed)
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  add_dependencies(fuzzers ${name})
endforeach()

add_executable(fuzz_seeds EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/fuzz/seeds.cpp)
target_link_libraries(fuzz_seeds PRIVATE burr_fuzzed)
target_compile_definitions(fuzz_seeds PRIVATE BURR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
add_dependencies(fuzzers fuzz_seeds)
