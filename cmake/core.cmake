# burr_core: touching and cutting bone, and the surface of what is left. Needs Eigen, the C++ library and nothing else;
# it starts no thread that its caller did not ask for. Compiled for x86-64, for ARM and for a browser
# (cmake/portable.cmake), so nothing in these rooms may know more than rt/ does about the machine.
set(BURR_CORE_SOURCES
  base/check.cpp base/version.cpp device/hand_path.cpp device/pushed_hand.cpp device/simulated_hand.cpp)  # of rooms that are not core as a whole
list(TRANSFORM BURR_CORE_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/src/burr/)
foreach(room math rt volume tool edit haptics surface thermal tick)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/burr/${room}/*.cpp)
  list(APPEND BURR_CORE_SOURCES ${sources})
endforeach()
# What asks the system has a source for each system: x.cpp is for Linux; x_windows.cpp stands for it on Windows, and x_plain.cpp
# where there are no memory calls and no scheduler (a browser).
set(stands_in none)
if(WIN32)
  set(stands_in windows)
elseif(NOT CMAKE_SYSTEM_NAME STREQUAL "Linux")
  set(stands_in plain)
endif()
foreach(kind plain windows)
  set(mine ${BURR_CORE_SOURCES})
  list(FILTER mine INCLUDE REGEX "_${kind}\\.cpp$")
  if(kind STREQUAL stands_in)
    list(TRANSFORM mine REPLACE "_${kind}\\.cpp$" ".cpp")
  endif()
  list(REMOVE_ITEM BURR_CORE_SOURCES ${mine})
endforeach()
# burr_windows(SOURCE...): they include windows.h, which defines thousands of names, so they are compiled alone
function(burr_windows)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
    COMPILE_DEFINITIONS "_WIN32_WINNT=0x0A00;WIN32_LEAN_AND_MEAN;NOMINMAX")
endfunction()
if(WIN32)
  set(mine ${BURR_CORE_SOURCES})
  list(FILTER mine INCLUDE REGEX "_windows\\.cpp$")
  burr_windows(${mine})
endif()

# Kernels exist once per instruction set, from one source, and are chosen at run time; the bits are the same.
# The wide ones are x86-64's (kWideKernels in rt/simd.h).
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  list(FILTER BURR_CORE_SOURCES EXCLUDE REGEX "_avx(2|512)\\.cpp$")
endif()
set(BURR_WIDE "")
if(MINGW)  # g++ for Windows puts wide numbers where the stack is not aligned for them (GCC bug 54412)
  set(BURR_WIDE ";-Wa,-muse-unaligned-vector-move")
endif()
function(burr_kernels)
  foreach(source ${ARGN})
    if(source MATCHES "_(avx2|avx512|scalar)\\.cpp$")
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)  # other options, other headers
    endif()
    if(source MATCHES "_avx2\\.cpp$")
      set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "-mavx2;-O3${BURR_WIDE}")
    elseif(source MATCHES "_avx512\\.cpp$")
      set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS
        "-mavx512f;-mavx512bw;-mavx512vl;-mavx512dq;-mprefer-vector-width=512;-O3${BURR_WIDE}")
    elseif(source MATCHES "_scalar\\.cpp$")
      set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "-O3")
    endif()
  endforeach()
endfunction()
burr_kernels(${BURR_CORE_SOURCES})
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/burr/rt/thread.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # core_is_light.sh
set_property(SOURCE ${PROJECT_SOURCE_DIR}/src/burr/base/version.cpp APPEND PROPERTY
  COMPILE_DEFINITIONS BURR_VERSION="${PROJECT_VERSION}")

if(BURR_CORE_ONLY)
  add_library(burr_core STATIC ${BURR_CORE_SOURCES})
else()
  add_library(burr_core SHARED ${BURR_CORE_SOURCES})
endif()
add_library(burr::core ALIAS burr_core)
set_target_properties(burr_core PROPERTIES EXPORT_NAME core VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
target_include_directories(burr_core PUBLIC
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(burr_core PUBLIC cxx_std_20)
target_link_libraries(burr_core PUBLIC Eigen3::Eigen Threads::Threads PRIVATE $<BUILD_INTERFACE:burr_options>)
if(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT BURR_SANITIZE)
  target_link_options(burr_core PRIVATE -Wl,-z,defs)  # nothing is left for others to bring
endif()
burr_common_headers(burr_core)
