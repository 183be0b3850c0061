# SPDX-License-Identifier: Apache-2.0
# Flags every target of the project shares.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

# For what no image waits for: it compiles in two thirds of the time.
set(PENUMBRA_QUICK_BUILD $<$<CONFIG:Release>:-O1>)

# Many sources in one unit compile in half the time. OFF is quicker for who changes one of them.
if(NOT DEFINED CMAKE_UNITY_BUILD)
  set(CMAKE_UNITY_BUILD ON)
endif()
set(CMAKE_UNITY_BUILD_BATCH_SIZE 50)
# An archive does not wait for those that it will be linked with.
set(CMAKE_OPTIMIZE_DEPENDENCIES ON)
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

add_library(penumbra_flags INTERFACE)
# Contraction to FMA is decided in the kernels, never inherited from the compiler.
target_compile_options(penumbra_flags INTERFACE -ffp-contract=off
  # GCC collects garbage less often: saves a tenth of its time, costs 300 MB.
  "$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-expand=300 --param ggc-min-heapsize=500000>")
if(PENUMBRA_WARNINGS_AS_ERRORS)
  target_compile_options(penumbra_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow
    -Wnon-virtual-dtor -Wold-style-cast -Wunused -Woverloaded-virtual -Werror
    # GCC 12 warns falsely of strings put together with + (its bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread>)
endif()
if(PENUMBRA_SANITIZE)
  target_compile_options(penumbra_flags INTERFACE -fsanitize=${PENUMBRA_SANITIZE}
                         -fno-sanitize-recover=all -fno-omit-frame-pointer
                         # GCC 12 warns falsely inside the standard library with sanitizers on.
                         $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(penumbra_flags INTERFACE -fsanitize=${PENUMBRA_SANITIZE})
endif()

set(PENUMBRA_ROOMS "" CACHE STRING "The only folders of the core to build; a room needs those before it")
mark_as_advanced(PENUMBRA_ROOMS)

# penumbra_library(TARGET): makes the library penumbra or penumbra_NAME, which others know
# as Penumbra::penumbra or Penumbra::NAME.
function(penumbra_library library)
  string(REGEX REPLACE "^penumbra_" "" name ${library})
  add_library(${library})
  add_library(Penumbra::${name} ALIAS ${library})
  target_compile_features(${library} PUBLIC cxx_std_20)
  target_include_directories(${library} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${library} PRIVATE Threads::Threads $<BUILD_INTERFACE:penumbra_flags>)
  set_target_properties(${library} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
                                              SOVERSION ${PROJECT_VERSION_MAJOR})
endfunction()

# penumbra_room(LIBRARY ROOM source...): adds a folder's sources to a library.
function(penumbra_room library room)
  if(PENUMBRA_ROOMS AND NOT room IN_LIST PENUMBRA_ROOMS)
    return()
  endif()
  if(NOT TARGET ${library})
    penumbra_library(${library})
  endif()
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/${room}/)
  list(TRANSFORM ARGN APPEND .cpp)
  target_sources(${library} PRIVATE ${ARGN})
endfunction()
