# SPDX-License-Identifier: Apache-2.0
# Installs the build tree into an empty prefix, then configures, builds and runs the consumer there.
function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGN}\n${text}")
  endif()
  set(output "${text}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${work})
step(${CMAKE_COMMAND} --install ${build} --prefix ${work}/prefix)
step(${CMAKE_COMMAND} -S ${source} -B ${work}/build -G Ninja -D CMAKE_BUILD_TYPE=${type}
     -D CMAKE_PREFIX_PATH=${work}/prefix)
step(${CMAKE_COMMAND} --build ${work}/build)
step(${work}/build/consumer)
if(NOT output MATCHES "penumbra ${version}: depth 1.4, occluded 81")
  message(FATAL_ERROR "the consumer said: ${output}")
endif()

# What an installed header includes of Penumbra is installed, too.
file(GLOB_RECURSE headers ${work}/prefix/include/penumbra/*.hpp)
list(LENGTH headers count)
if(count LESS 20)
  message(FATAL_ERROR "only ${count} headers are installed")
endif()
file(GLOB_RECURSE live_headers ${work}/prefix/include/penumbra_live/*.hpp)
foreach(header IN LISTS headers live_headers)
  file(STRINGS ${header} includes REGEX "^#include <(penumbra|io)/")
  foreach(line IN LISTS includes)
    string(REGEX REPLACE "^#include <(.*)>.*" "\\1" name "${line}")
    if(NOT EXISTS ${work}/prefix/include/${name} AND
       NOT EXISTS ${work}/prefix/include/penumbra_live/${name})
      message(FATAL_ERROR "${header} includes ${name}, which is not installed")
    endif()
  endforeach()
endforeach()
