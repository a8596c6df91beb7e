# How everything is compiled.  Replay is to the bit, so no fused multiply-add and no fast-math anywhere.
find_program(BURR_CCACHE ccache)
if(BURR_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${BURR_CCACHE})
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
if(BURR_SANITIZE)
  target_compile_options(burr_options INTERFACE -fsanitize=${BURR_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(burr_options INTERFACE -fsanitize=${BURR_SANITIZE})
  target_compile_definitions(burr_options INTERFACE BURR_SANITIZED=1)
  if(BURR_SANITIZE MATCHES "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # it does not model fences (rt/versioned.h); the words they order are atomics, which never race
    target_compile_options(burr_options INTERFACE -Wno-tsan)
  endif()
endif()
