# Before each package is packed: programs and libraries find libburr where the system looks, not by a path of their own.
file(GLOB_RECURSE files LIST_DIRECTORIES OFF ${CPACK_TEMPORARY_DIRECTORY}/*)
foreach(file ${files})
  if(IS_SYMLINK ${file})
    continue()
  endif()
  file(READ ${file} magic LIMIT 4 HEX)
  if(magic STREQUAL 7f454c46)  # ELF
    file(RPATH_REMOVE FILE ${file})
  endif()
endforeach()
