# How everything is compiled.  Replay is to the bit, so no fused multiply-add and no fast-math anywhere.
find_program(BURR_CCACHE ccache)
if(BURR_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${BURR_CCACHE})
  if(BURR_PCH)  # else ccache leaves alone what begins with a precompiled header
    set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${BURR_CCACHE})
    if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
      add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
    endif()
  endif()
endif()

add_library(burr_options INTERFACE)
target_compile_options(burr_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor -Wold-style-cast
  -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(BURR_WERROR)
  target_compile_options(burr_options INTERFACE -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # inside the shared library our own calls stay direct
  target_compile_options(burr_options INTERFACE -fno-semantic-interposition)
  # g++ 12 sees ghosts in optimised Eigen and std::string code (PR 105562, 105651)
  target_compile_options(burr_options INTERFACE -Wno-maybe-uninitialized -Wno-restrict)
endif()
# burr_common_headers(TARGET [HEADER...] or REUSE_FROM OTHER): parsed once, not once a file. Never in the
# release build, which shows that each file includes what it uses.
set(BURR_COMMON_HEADERS <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <atomic> <chrono> <cmath> <cstdint>
  <cstring> <filesystem> <fstream> <functional> <map> <memory> <mutex> <optional> <random> <span> <sstream> <string>
  <string_view> <thread> <utility> <vector>)
function(burr_common_headers target)
  if(BURR_PCH AND "${ARGV1}" STREQUAL "REUSE_FROM")
    target_precompile_headers(${target} REUSE_FROM ${ARGV2})
  elseif(BURR_PCH)
    target_precompile_headers(${target} PRIVATE ${BURR_COMMON_HEADERS} ${ARGN})
  endif()
endfunction()

if(BURR_SANITIZE)
  target_compile_options(burr_options INTERFACE -fsanitize=${BURR_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(burr_options INTERFACE -fsanitize=${BURR_SANITIZE})
  target_compile_definitions(burr_options INTERFACE BURR_SANITIZED=1)
  if(BURR_SANITIZE MATCHES "undefined")
    # checks of every pointer followed: they take up to half of the compiler's time, AddressSanitizer sees what comes
    # of most of them, and what reads files has them all (burr_reads_files)
    target_compile_options(burr_options INTERFACE -fno-sanitize=null,alignment,vptr,object-size,pointer-overflow)
  endif()
  if(BURR_SANITIZE MATCHES "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # it does not model fences (rt/versioned.h); the words they order are atomics, which never race
    target_compile_options(burr_options INTERFACE -Wno-tsan)
  endif()
endif()

# burr_reads_files(SOURCE...): what strangers' files go through; in the build `asan` with every check, and with the
# counters by which the fuzzers see which code an input reaches
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

# burr_glue(TARGET): code that only calls the library, where the time goes. Compiles in a sixth to two fifths less time.
function(burr_glue target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()
