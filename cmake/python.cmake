# The module `burr` for Python (docs/use/python.md), in build/.../python/burr. Debian's own Python: only that one has Debian's numpy.
find_program(BURR_PYTHON_PROGRAM NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(BURR_PYTHON_PROGRAM NAMES python3)
set(Python_EXECUTABLE ${BURR_PYTHON_PROGRAM})
find_package(Python 3.11 REQUIRED COMPONENTS Interpreter Development.Module)
find_package(pybind11 2.10 REQUIRED)

file(GLOB BURR_PYTHON_SOURCES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/src/*.cpp)
pybind11_add_module(burr_python MODULE NO_EXTRAS ${BURR_PYTHON_SOURCES})
set_target_properties(burr_python PROPERTIES OUTPUT_NAME _burr LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/python/burr
  CXX_VISIBILITY_PRESET hidden)
target_link_libraries(burr_python PRIVATE burr burr_options fmt::fmt)
burr_glue(burr_python)

# the files that are Python, beside it
file(GLOB BURR_PYTHON_FILES CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/python/burr
  ${PROJECT_SOURCE_DIR}/python/burr/*.py ${PROJECT_SOURCE_DIR}/python/burr/*.pyi ${PROJECT_SOURCE_DIR}/python/burr/py.typed)
set(copies "")
foreach(file ${BURR_PYTHON_FILES})
  set(copy ${CMAKE_BINARY_DIR}/python/burr/${file})
  add_custom_command(OUTPUT ${copy} DEPENDS ${PROJECT_SOURCE_DIR}/python/burr/${file}
    COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/python/burr/${file} ${copy} VERBATIM)
  list(APPEND copies ${copy})
endforeach()
add_custom_target(burr_python_files ALL DEPENDS ${copies})
add_dependencies(burr_python burr_python_files)

# where Debian's Python looks below /usr; the name of the module's file tells versions of Python apart
set(BURR_PYTHON_DIR lib/python3/dist-packages CACHE STRING "folder of the module, from the prefix")
file(RELATIVE_PATH to_libraries /${BURR_PYTHON_DIR}/burr /${CMAKE_INSTALL_LIBDIR})
set_target_properties(burr_python PROPERTIES INSTALL_RPATH "$ORIGIN/${to_libraries}")
install(TARGETS burr_python LIBRARY DESTINATION ${BURR_PYTHON_DIR}/burr COMPONENT python)
list(TRANSFORM BURR_PYTHON_FILES PREPEND ${PROJECT_SOURCE_DIR}/python/burr/)
install(FILES ${BURR_PYTHON_FILES} DESTINATION ${BURR_PYTHON_DIR}/burr COMPONENT python)
install(CODE "message(STATUS \"Python finds burr with PYTHONPATH=\${CMAKE_INSTALL_PREFIX}/${BURR_PYTHON_DIR}\")" COMPONENT python)

# tests/python/x_test.py -> one test each; they also run the program, and settings_test.py what C++ says
if(BURR_TESTS AND TARGET burr_program)
  add_executable(setting_trial ${PROJECT_SOURCE_DIR}/tests/python/setting_trial.cpp)
  target_link_libraries(setting_trial PRIVATE burr burr_options)
  file(GLOB tests CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/python/*_test.py)
  foreach(test ${tests})
    get_filename_component(name ${test} NAME_WE)
    string(REGEX REPLACE "_test$" "" name ${name})
    add_test(NAME python.${name} COMMAND ${Python_EXECUTABLE} -X dev -W error ${test})
    set_tests_properties(python.${name} PROPERTIES TIMEOUT 300
      ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1;BURR_PROGRAM=$<TARGET_FILE:burr_program>;BURR_CHECKOUT=${PROJECT_SOURCE_DIR}")
  endforeach()
  # refused by the gate twice for a reason not found; it passes alone (./test, --again)
  set_property(TEST python.law APPEND PROPERTY LABELS again)
endif()
