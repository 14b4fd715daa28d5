# Build options and the one function that makes a grainlaw library.
include(CMakeDependentOption)
option(GRAINLAW_DEM "Build the DEM engine (needs HDF5)" ON)
option(GRAINLAW_MODEL "Build the constitutive model (needs SUNDIALS, Eigen)" ON)
cmake_dependent_option(GRAINLAW_CALIBRATE "Build the calibration (needs Ceres, the DEM and the model)" ON
                       "GRAINLAW_DEM;GRAINLAW_MODEL" OFF)
cmake_dependent_option(GRAINLAW_APPS "Build the program grainlaw (needs CLI11, spdlog)" ON "GRAINLAW_CALIBRATE" OFF)
option(GRAINLAW_TESTS "Build the tests (needs GoogleTest)" ON)
option(GRAINLAW_SANITIZE "AddressSanitizer and UndefinedBehaviorSanitizer" OFF)
option(GRAINLAW_WERROR "Warnings are errors" OFF)
# Two that halve the time to build: a compiler cache cannot see through the first, and compiles more than changed by the second.
cmake_dependent_option(GRAINLAW_PRECOMPILE "Precompile the headers that nearly every file includes" ON
                       "NOT CMAKE_CXX_COMPILER_LAUNCHER" OFF)
cmake_dependent_option(GRAINLAW_BATCHES "Compile sources in batches of six files" ON
                       "NOT CMAKE_CXX_COMPILER_LAUNCHER" OFF)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# Headers are included as <grainlaw/room/file.hpp>, from the source tree as from an installation.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/include/grainlaw SYMBOLIC)

add_library(grainlaw_warnings INTERFACE)
target_compile_options(grainlaw_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Wold-style-cast -Woverloaded-virtual $<$<BOOL:${GRAINLAW_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms of g++ 12 where strings are joined or moved (GCC bugs 105329 and 105651).
  target_compile_options(grainlaw_warnings INTERFACE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow
                         -Wno-stringop-overread)
endif()
if(GRAINLAW_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  add_link_options(-fsanitize=address,undefined)
endif()

include(${CMAKE_CURRENT_LIST_DIR}/batches.cmake)

# grainlaw_precompile(target HEADERS): these and the ones that every room includes, once for all sources of the target. Or
# FROM an earlier target with the same flags, once for both.
function(grainlaw_precompile target)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" FROM "")
  if(NOT GRAINLAW_PRECOMPILE)
    return()
  endif()
  if(ARG_FROM)
    target_precompile_headers(${target} REUSE_FROM ${ARG_FROM})
  else()
    target_precompile_headers(${target} PRIVATE <nlohmann/json.hpp> <algorithm> <array> <cmath> <cstdint> <filesystem>
                              <functional> <map> <optional> <sstream> <string> <variant> <vector>
                              ${ARG_UNPARSED_ARGUMENTS})
  endif()
endfunction()

# grainlaw_quick_to_compile(target): for code in which no time is spent, a quarter of the compiler's (half of it under the
# sanitizers).
function(grainlaw_quick_to_compile target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(GRAINLAW_SANITIZE)
    target_compile_options(${target} PRIVATE -O0)
  endif()
endfunction()

# grainlaw_library(room FOLDERS [ALONE NAMES]): the sources of this folder, and of these within it, as grainlaw::room. No
# batch takes in those of the folders and files ALONE, in which time is spent: they are optimised by themselves.
function(grainlaw_library room)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" ALONE)
  set(patterns ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  foreach(folder ${ARG_UNPARSED_ARGUMENTS})
    list(APPEND patterns ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  add_library(grainlaw_${room} STATIC ${sources})
  add_library(grainlaw::${room} ALIAS grainlaw_${room})
  set_target_properties(grainlaw_${room} PROPERTIES EXPORT_NAME ${room})
  target_include_directories(grainlaw_${room} PUBLIC $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                                                     $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(grainlaw_${room} PUBLIC cxx_std_20)
  target_link_libraries(grainlaw_${room} PRIVATE $<BUILD_INTERFACE:grainlaw_warnings>)
  if(GRAINLAW_BATCHES)
    foreach(name ${ARG_ALONE})
      list(FILTER sources EXCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/${name}(/|$)")
    endforeach()
    grainlaw_batch_sources(grainlaw_${room} ${sources})
  endif()
endfunction()
