# Tables of letters, which burr's readers need for names in other writing than UTF-8: made of Python's codecs, in the folder of the
# build. BURR_LETTERS: where they are included from.
find_package(Python3 COMPONENTS Interpreter REQUIRED)
set(BURR_LETTERS ${CMAKE_BINARY_DIR}/letters)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scripts/letters.py)
set(tables ${BURR_LETTERS}/burr/io/read/letters_tables.h)
if(${PROJECT_SOURCE_DIR}/scripts/letters.py IS_NEWER_THAN ${tables})
  file(MAKE_DIRECTORY ${BURR_LETTERS}/burr/io/read)
  execute_process(COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/letters.py ${tables} COMMAND_ERROR_IS_FATAL ANY)
endif()
