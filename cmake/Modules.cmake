# raygrain_module(NAME USES module... PRIVATE library...): the sources under src/NAME as a static library raygrain_NAME.
# raygrain_library(): all modules as the one library that is installed.

add_library(raygrain_options INTERFACE)
target_compile_features(raygrain_options INTERFACE cxx_std_20)
target_compile_options(raygrain_options INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror -ffp-contract=off)
# GCC 12 leaves out the rounding to float where it makes vectors of neighbouring double -> float -> double conversions.
target_compile_options(raygrain_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
# What calls what within a library stays so: GCC may put calls in line in code for shared libraries, too, as Clang does.
target_compile_options(raygrain_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
if(RAYGRAIN_SANITIZE)
  target_compile_options(raygrain_options INTERFACE -fsanitize=${RAYGRAIN_SANITIZE} -fno-omit-frame-pointer
                                                   -fno-sanitize-recover=all)
  target_link_options(raygrain_options INTERFACE -fsanitize=${RAYGRAIN_SANITIZE})
endif()
if(RAYGRAIN_COVERAGE)
  target_compile_options(raygrain_options INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(raygrain_options INTERFACE --coverage)
endif()
target_compile_definitions(raygrain_options INTERFACE
  $<$<OR:$<CONFIG:Debug>,$<BOOL:${RAYGRAIN_CHECKS}>>:RAYGRAIN_CHECKS>
  $<$<BOOL:${RAYGRAIN_STD_THREADS}>:RAYGRAIN_STD_THREADS>)

set(RAYGRAIN_MODULES "" CACHE INTERNAL "")

# The standard headers that nearly every source reads, read once where GCC compiles: a quarter of its time. Presets switch
# it off where GCC 12 then warns about the inside of std::string, and for Clang, so that each file includes what it needs.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  file(WRITE ${PROJECT_BINARY_DIR}/generated/standard_headers.cpp "// Nothing but what the precompiled headers hang on.\n")
  add_library(raygrain_standard_headers OBJECT ${PROJECT_BINARY_DIR}/generated/standard_headers.cpp)
  set_target_properties(raygrain_standard_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(raygrain_standard_headers PRIVATE raygrain_options)
  target_precompile_headers(raygrain_standard_headers PRIVATE
    <algorithm> <array> <cmath> <functional> <memory> <optional> <span> <string> <vector>)
endif()

function(raygrain_module name)
  cmake_parse_arguments(ARG "" "" "USES;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  add_library(raygrain_${name} STATIC ${sources})
  set_target_properties(raygrain_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON LINKER_LANGUAGE CXX)
  if(TARGET raygrain_standard_headers)
    target_precompile_headers(raygrain_${name} REUSE_FROM raygrain_standard_headers)
  endif()
  target_include_directories(raygrain_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  list(TRANSFORM ARG_USES PREPEND raygrain_)
  target_link_libraries(raygrain_${name} PUBLIC ${ARG_USES} PRIVATE raygrain_options ${ARG_PRIVATE})
  if(name STREQUAL base)
    target_link_libraries(raygrain_base PRIVATE Threads::Threads $<$<NOT:$<BOOL:${RAYGRAIN_STD_THREADS}>>:TBB::tbb>)
  endif()
  set(RAYGRAIN_MODULES ${RAYGRAIN_MODULES} ${name} CACHE INTERNAL "")
endfunction()

function(raygrain_library)
  set(objects "")
  foreach(module ${RAYGRAIN_MODULES})
    list(APPEND objects $<TARGET_OBJECTS:raygrain_${module}>)
  endforeach()
  add_library(raygrain ${objects})
  add_library(raygrain::raygrain ALIAS raygrain)
  set_target_properties(raygrain PROPERTIES LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
  target_compile_features(raygrain PUBLIC cxx_std_20)
  target_include_directories(raygrain PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                             $<INSTALL_INTERFACE:include>)
  target_link_libraries(raygrain PRIVATE Threads::Threads $<$<NOT:$<BOOL:${RAYGRAIN_STD_THREADS}>>:TBB::tbb>
                                         assimp::assimp fmt::fmt ZLIB::ZLIB ${RAYGRAIN_HIGHWAY_LIBRARY} $<BUILD_INTERFACE:raygrain_options>)
endfunction()
