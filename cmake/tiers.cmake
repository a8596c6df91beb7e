# The full tier: what `./test` leaves out and `./test --full` runs. The gate (.ci/run) runs `./test` and one part of the
# full tier, each part at least every fourth time: scripts/gate_share.py chooses it by the label full-N.
set(full_1 "^tsan[.]")
set(full_2 "^clang[.]|^portable[.]aarch64|^house[.]verify_scores$")
set(full_3 "^portable[.](web|windows)|^page$|^page_(more|firefox|framed|npm|published)$|^school_page$")
set(full_4 "^batch_slurm$|^fuzz[.]|^house[.](package|install|headers_compile_alone|tidy)$|^asan[.](more_build|rt|math|tool|haptics|tick|device|school|net)$")
get_property(tests DIRECTORY PROPERTY TESTS)  # not those that test programs tell ctest: they are all in `./test`
foreach(test ${tests})
  foreach(part 1 2 3 4)
    if(test MATCHES "${full_${part}}")
      set_property(TEST ${test} APPEND PROPERTY LABELS full-${part})
    endif()
  endforeach()
endforeach()
