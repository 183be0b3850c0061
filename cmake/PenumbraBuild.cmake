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

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

add_library(penumbra_flags INTERFACE)
# Contraction to FMA is decided in the kernels, never inherited from the compiler.
target_compile_options(penumbra_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Wold-style-cast -Wunused -Woverloaded-virtual -ffp-contract=off
                       # GCC 12 warns falsely of strings put together with + (its bug 105651).
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(PENUMBRA_WARNINGS_AS_ERRORS)
  target_compile_options(penumbra_flags INTERFACE -Werror)
endif()
if(PENUMBRA_SANITIZE)
  target_compile_options(penumbra_flags INTERFACE -fsanitize=${PENUMBRA_SANITIZE}
                         -fno-sanitize-recover=all -fno-omit-frame-pointer
                         # GCC 12 warns falsely inside the standard library with sanitizers on.
                         $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(penumbra_flags INTERFACE -fsanitize=${PENUMBRA_SANITIZE})
endif()
