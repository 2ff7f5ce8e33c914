# cmake -DBINARY=FILE -DLABELS=... -DOUT=FILE -P list_suites.cmake: writes a file for CTest, a test for each suite
# of a test binary. A process of its own for each case would spend more processor time on starting than on testing.
execute_process(COMMAND ${BINARY} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
get_filename_component(name ${BINARY} NAME)
get_filename_component(folder ${BINARY} DIRECTORY)
string(REGEX MATCHALL "(^|\n)[^ \n]+[.]" suites "${listed}")
set(tests "")
foreach(suite IN LISTS suites)
  string(STRIP "${suite}" suite)
  string(REGEX REPLACE "[.]$" "" test "${name}.${suite}")
  string(APPEND tests "add_test([=[${test}]=] ${BINARY} [=[--gtest_filter=${suite}*]=])\n"
    "set_tests_properties([=[${test}]=] PROPERTIES WORKING_DIRECTORY ${folder} LABELS \"${LABELS}\")\n")
endforeach()
file(WRITE ${OUT} "${tests}")
