# SPDX-License-Identifier: Apache-2.0
penumbra_test(test_mesh_file SOURCES assimp_leaks.cpp ${CMAKE_CURRENT_LIST_DIR}/mesh_file_test.cpp
              ${CMAKE_CURRENT_LIST_DIR}/mesh_bad_file_test.cpp)
penumbra_test(test_mesh_primitives SOURCES ${CMAKE_CURRENT_LIST_DIR}/mesh_primitives_test.cpp)
penumbra_test(test_offset SOURCES ${CMAKE_CURRENT_LIST_DIR}/offset_grid_test.cpp
              ${CMAKE_CURRENT_LIST_DIR}/offset_grow_test.cpp
              ${CMAKE_CURRENT_LIST_DIR}/offset_shrink_test.cpp)
