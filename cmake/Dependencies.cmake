# Third-party packages, all from Debian. None of their headers is needed by raygrain's public headers.
find_package(Threads REQUIRED)
if(NOT RAYGRAIN_STD_THREADS)
  find_package(TBB REQUIRED)
endif()
find_package(Boost 1.74 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(assimp 5.2 REQUIRED)
find_package(ZLIB REQUIRED)

# Their headers are not ours to warn about.
add_library(raygrain_boost INTERFACE)
target_include_directories(raygrain_boost SYSTEM INTERFACE ${Boost_INCLUDE_DIRS})

add_library(raygrain_assimp INTERFACE)
target_link_libraries(raygrain_assimp INTERFACE assimp::assimp)

find_path(RAYGRAIN_STB_INCLUDE_DIR stb/stb_image_write.h REQUIRED)
add_library(raygrain_stb INTERFACE)
target_include_directories(raygrain_stb SYSTEM INTERFACE ${RAYGRAIN_STB_INCLUDE_DIR})

# Only its headers: nothing to link, but for the assertions that Clang's sanitizers switch on.
if(RAYGRAIN_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL Clang)
  find_library(RAYGRAIN_HIGHWAY_LIBRARY hwy REQUIRED)
endif()
find_path(RAYGRAIN_HIGHWAY_INCLUDE_DIR hwy/highway.h REQUIRED)
add_library(raygrain_highway INTERFACE)
target_include_directories(raygrain_highway SYSTEM INTERFACE ${RAYGRAIN_HIGHWAY_INCLUDE_DIR})
