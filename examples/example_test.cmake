# SPDX-License-Identifier: Apache-2.0
# Runs a program: it has to succeed, and to say what is asked for.
execute_process(COMMAND ${program} RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_VARIABLE text)
message("${text}")
if(NOT status EQUAL 0)
  message(FATAL_ERROR "exit status ${status}")
endif()
if(NOT text MATCHES "${says}")
  message(FATAL_ERROR "nothing like this was said: ${says}")
endif()
