# burr_core alone, and what checks it: for other processors, for Windows and for a browser. BURR_CORE_ONLY;
# presets `aarch64`, `windows`, `web`.
if(NOT EMSCRIPTEN)
  find_package(Threads REQUIRED)
else()  # one thread; none is ever started
  add_library(burr_no_threads INTERFACE)
  add_library(Threads::Threads ALIAS burr_no_threads)
endif()
# Eigen is headers, the same for every processor. Only its own folder: beside it lie the headers of this machine.
set(BURR_EIGEN /usr/include/eigen3 CACHE PATH "the folder that holds Eigen/Core")
if(NOT EXISTS ${BURR_EIGEN}/Eigen/Core)
  message(FATAL_ERROR "no Eigen in ${BURR_EIGEN}; give -DBURR_EIGEN=FOLDER")
endif()
add_library(burr_eigen INTERFACE)
target_include_directories(burr_eigen SYSTEM INTERFACE ${BURR_EIGEN})
add_library(Eigen3::Eigen ALIAS burr_eigen)
if(EMSCRIPTEN)
  # Eigen 3.4 takes clang for WebAssembly for something that it is not; math/sums.h says the order of additions
  target_compile_definitions(burr_eigen INTERFACE EIGEN_DONT_VECTORIZE)
  target_compile_options(burr_options INTERFACE -msimd128)
  # emscripten's helpers find Debian's acorn there
  set_property(GLOBAL PROPERTY RULE_LAUNCH_LINK "${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs")
endif()
include(cmake/core.cmake)

add_executable(portable_bits ${PROJECT_SOURCE_DIR}/tests/bits/portable_bits.cpp)
target_link_libraries(portable_bits PRIVATE burr_core burr_options)
if(EMSCRIPTEN)
  target_link_options(portable_bits PRIVATE -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=2GB -sNODERAWFS=1 -sEXIT_RUNTIME=1)
  include(${PROJECT_SOURCE_DIR}/web/page.cmake)
endif()

# The unit tests of the core's rooms that need nothing else. Not for a browser: gtest wants threads and files.
set(BURR_GOOGLETEST /usr/src/googletest CACHE PATH "the sources of googletest; Debian's package `googletest`")
if(NOT EMSCRIPTEN AND EXISTS ${BURR_GOOGLETEST}/CMakeLists.txt)
  set(INSTALL_GTEST OFF)
  set(BUILD_GMOCK OFF)
  add_subdirectory(${BURR_GOOGLETEST} ${CMAKE_BINARY_DIR}/googletest EXCLUDE_FROM_ALL)
  set(core_tests math/pose math/rotation math/sums tool/spindle volume/bone volume/sample volume/iso_vertices volume/thickness
    edit/carve edit/carve_units edit/brush edit/mirror haptics/limit haptics/energy_guard haptics/soft_contact)
  list(TRANSFORM core_tests REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/tests/\\1_test.cpp")
  set(lanes ${PROJECT_SOURCE_DIR}/tests/rt/lanes_checks_scalar.cpp)
  set(guard ${PROJECT_SOURCE_DIR}/tests/support/rt_guard.cpp)
  if(WIN32)  # the room that has sources of its own there, and the wide kernels
    set(room_rt clock stats doors slow_atoms reserved thread machine_check system_windows)
    list(TRANSFORM room_rt REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/tests/rt/\\1_test.cpp")
    list(APPEND core_tests ${room_rt} ${PROJECT_SOURCE_DIR}/tests/base/result_test.cpp)
    list(APPEND lanes ${PROJECT_SOURCE_DIR}/tests/rt/lanes_checks_avx2.cpp ${PROJECT_SOURCE_DIR}/tests/rt/lanes_checks_avx512.cpp)
    burr_kernels(${lanes})
    set(guard ${PROJECT_SOURCE_DIR}/tests/support/rt_guard_windows.cpp)
    burr_windows(${guard} ${PROJECT_SOURCE_DIR}/tests/rt/system_windows_test.cpp)
  endif()
  # bones by formula for the tests; no more of that room is needed
  add_executable(test_core ${core_tests} ${guard} ${PROJECT_SOURCE_DIR}/tests/rt/lanes_test.cpp ${lanes}
    ${PROJECT_SOURCE_DIR}/src/burr/phantom/build.cpp ${PROJECT_SOURCE_DIR}/src/burr/phantom/shapes.cpp)
  if(WIN32)
    set(BURR_GUARDED malloc calloc realloc free __imp__aligned_malloc __imp__aligned_free pthread_mutex_lock)
    list(TRANSFORM BURR_GUARDED PREPEND "LINKER:--wrap=" OUTPUT_VARIABLE wraps)
    target_link_options(test_core PRIVATE ${wraps})
  endif()
  target_include_directories(test_core PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(test_core PRIVATE burr_core burr_options gtest_main ${CMAKE_DL_LIBS})
  burr_glue(test_core)
endif()
