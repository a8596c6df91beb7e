# Compiler options. A replay must be exact to the bit, so no fused multiply-add and no fast-math
# anywhere.

# A compiler's cache (ccache), where there is one. What it must be told stands in the command, so it finds a source again
# in another folder too, whatever its user's own settings are: paths count from the project's folder, and the folder in
# which the compiler works is no part of what is compared. For the debugger it is: there an object names its sources.
find_program(BURR_CCACHE ccache)
if(BURR_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # The last words: otherwise ccache does not cache files that use a precompiled header. For this it keeps an old object under the
  # new text of a source that is edited while it compiles; CCACHE_RECACHE=1 cmake --build ... mends that.
  set(launcher env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_ABSSTDERR=1 CCACHE_DEPEND=1
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime)
  if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
    list(APPEND launcher CCACHE_NOHASHDIR=1)
  endif()
  foreach(language C CXX)
    set(CMAKE_${language}_COMPILER_LAUNCHER ${launcher} ${BURR_CCACHE})
  endforeach()
  if(BURR_PCH AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
  endif()
endif()
if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")  # no object says in which folder it was compiled
  add_compile_options(-ffile-prefix-map=${PROJECT_SOURCE_DIR}=.)
endif()

add_library(burr_options INTERFACE)
target_compile_options(burr_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor -Wold-style-cast
  -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(BURR_WERROR)
  target_compile_options(burr_options INTERFACE -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # inside the shared library, calls of our own functions stay direct
  target_compile_options(burr_options INTERFACE -fno-semantic-interposition)
  # g++ 12 gives false warnings in optimised Eigen and std::string code (PR 105562, 105651)
  target_compile_options(burr_options INTERFACE -Wno-maybe-uninitialized -Wno-restrict)
endif()
# burr_common_headers(TARGET [HEADER...] or REUSE_FROM OTHER): headers parsed once instead of once a
# file, which saves a third of the time of a build. The builds for other processors have none, so they
# show that each file of the core includes what it uses; -DBURR_PCH=OFF shows it for all files.
set(BURR_COMMON_HEADERS <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <atomic> <chrono> <cmath> <cstdint>
  <cstring> <filesystem> <fstream> <functional> <map> <memory> <mutex> <optional> <random> <span> <sstream> <string>
  <string_view> <thread> <utility> <vector>)
function(burr_common_headers target)
  if(NOT BURR_PCH OR BURR_CORE_ONLY)
    return()
  endif()
  if(BURR_TOGETHER AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    # Of clang++ they hold the folder in which they were made, so no cache would find a source again elsewhere; and where
    # sources are compiled as one they save nothing (13.0 s with them, 12.5 s without, for a group of burr_core).
    return()
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # of a precompiled header g++ 12 warns as if it were ours: false alarms in <string>
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
  endif()
  if("${ARGV1}" STREQUAL "REUSE_FROM")
    target_precompile_headers(${target} REUSE_FROM ${ARGV2})
  else()
    target_precompile_headers(${target} PRIVATE ${BURR_COMMON_HEADERS} ${ARGN})
  endif()
endfunction()

# CMake forgets the settings of a preset when the preset's compiler is not the one that the folder had.
if(CMAKE_BINARY_DIR MATCHES "/build/(asan|tsan)$" AND NOT BURR_SANITIZE)
  message(FATAL_ERROR "${CMAKE_BINARY_DIR} was made with another compiler; delete it and run cmake --preset ${CMAKE_MATCH_1} again")
endif()
if(BURR_SANITIZE)
  target_compile_options(burr_options INTERFACE -fsanitize=${BURR_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(burr_options INTERFACE -fsanitize=${BURR_SANITIZE})
  target_compile_definitions(burr_options INTERFACE BURR_SANITIZED=1)
  if(BURR_SANITIZE MATCHES "undefined")
    # of a path the last three names, so an object is the same in another folder
    target_compile_options(burr_options INTERFACE -fsanitize-undefined-strip-path-components=-3)
    # Checks of every pointer use: they take up to half of the compiler's time, and AddressSanitizer
    # finds most of what they would find. Code that reads files has them all (burr_reads_files).
    target_compile_options(burr_options INTERFACE -fno-sanitize=null,alignment,vptr,object-size,pointer-overflow)
  endif()
  if(BURR_SANITIZE MATCHES "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # ThreadSanitizer does not model fences (rt/versioned.h); the words that they order are atomics,
    # which cannot race
    target_compile_options(burr_options INTERFACE -Wno-tsan)
  endif()
endif()

# burr_reads_files(SOURCE...): code that reads files of unknown origin; in the build `asan` with
# every check, and with the counters that show the fuzzers which code an input reaches
function(burr_reads_files)
  if(BURR_SANITIZE MATCHES "undefined")
    set(every "-fsanitize=null,alignment,object-size,pointer-overflow")
    if(BURR_FUZZ)
      list(APPEND every "-fsanitize-coverage=inline-8bit-counters,indirect-calls,trace-cmp,pc-table")
    endif()
    foreach(source ${ARGN})
      set_property(SOURCE ${source} APPEND PROPERTY COMPILE_OPTIONS ${every})
    endforeach()
  endif()
endfunction()

# burr_glue(TARGET): code that only calls the library, which does the slow work. These options save
# a sixth to two fifths of its compile time; with AddressSanitizer, up to two thirds. With
# ThreadSanitizer the window would run three times as long, so there it stays as it is.
function(burr_glue target)
  if(BURR_SANITIZE MATCHES "address")
    target_compile_options(${target} PRIVATE $<$<CONFIG:RelWithDebInfo>:-O0>)
  elseif(NOT BURR_SANITIZE)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()
# burr_glue_for_asan(TARGET): a part of the library of which no tick and no large volume waits
function(burr_glue_for_asan target)
  if(BURR_SANITIZE MATCHES "address")
    burr_glue(${target})
  endif()
endfunction()
