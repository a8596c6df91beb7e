# fuzz/x_fuzz.cpp -> fuzz_x: one small program per reader, which searches for inputs that break it;
# and fuzz_seeds, which makes the first inputs. See docs/develop/fuzzing.md. Only in the preset `asan`,
# whose library they use.
if(NOT BURR_SANITIZE MATCHES "address" OR NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "BURR_FUZZ needs clang++ (libFuzzer) and AddressSanitizer: cmake --preset asan")
endif()

# common to all targets; the readers and everything for a replay come from the sanitized library
add_library(burr_fuzzed STATIC EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/fuzz/support.cpp)
target_include_directories(burr_fuzzed PUBLIC ${PROJECT_SOURCE_DIR}/fuzz)
target_link_libraries(burr_fuzzed PUBLIC burr burr_readers burr_options fmt::fmt PkgConfig::ZSTD nlohmann_json::nlohmann_json)

add_custom_target(fuzzers)
file(GLOB fuzz_targets CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/fuzz/*_fuzz.cpp)
foreach(source ${fuzz_targets})
  get_filename_component(name ${source} NAME_WE)
  string(REGEX REPLACE "(.*)_fuzz$" "fuzz_\\1" name ${name})
  add_executable(${name} EXCLUDE_FROM_ALL ${source})
  target_link_libraries(${name} PRIVATE burr_fuzzed)
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/fuzz)
  add_dependencies(fuzzers ${name})
endforeach()

add_executable(fuzz_seeds EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/fuzz/seeds.cpp)
target_link_libraries(fuzz_seeds PRIVATE burr_fuzzed)
set_target_properties(fuzz_seeds PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/fuzz)
add_dependencies(fuzzers fuzz_seeds)
