# SPDX-License-Identifier: Apache-2.0
find_package(assimp REQUIRED)
penumbra_test(test_mesh_file SOURCES assimp_leaks.cpp ${CMAKE_CURRENT_LIST_DIR}/mesh_file_test.cpp
              ${CMAKE_CURRENT_LIST_DIR}/mesh_bad_file_test.cpp)
penumbra_test(test_mesh_collada SOURCES assimp_leaks.cpp
              ${CMAKE_CURRENT_LIST_DIR}/mesh_collada_test.cpp
              ${CMAKE_CURRENT_LIST_DIR}/mesh_polygon_test.cpp LIBS assimp::assimp)
penumbra_test(test_mesh_fuzz SOURCES assimp_leaks.cpp ${CMAKE_CURRENT_LIST_DIR}/mesh_fuzz_test.cpp)
penumbra_test(test_mesh_primitives RECKONS SOURCES ${CMAKE_CURRENT_LIST_DIR}/mesh_primitives_test.cpp)
penumbra_test(test_offset RECKONS SOURCES ${CMAKE_CURRENT_LIST_DIR}/surface_offset_test.cpp)
