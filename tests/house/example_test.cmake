# SPDX-License-Identifier: Apache-2.0
# Draws a frame of the shipped recording (all frames where PENUMBRA_FULL is set) and everything
# beside the frames anew: the bytes must be those in the repository.
set(frames 5 5)
if(DEFINED ENV{PENUMBRA_FULL})
  set(frames)
endif()
file(REMOVE_RECURSE ${work})
execute_process(COMMAND ${tool} ${work} ${frames} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB_RECURSE drawn RELATIVE ${work} ${work}/*)
list(LENGTH drawn count)
if(count LESS 15)
  message(FATAL_ERROR "only ${count} files were drawn")
endif()
foreach(file ${drawn})
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${work}/${file} ${shipped}/${file}
                  RESULT_VARIABLE differs)
  if(differs)
    message(SEND_ERROR "${file} is not what the repository has")
  endif()
endforeach()
