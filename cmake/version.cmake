# Version, commit and options of the build, for element/version.cpp alone: a new commit, or another change of a source,
# compiles that one file and links again.
#
# Included by CMakeLists.txt, this defines grainlaw_version(target). Run as a script (cmake -P) at every build, it writes
# OUTPUT, and only if its text has changed.

if(CMAKE_SCRIPT_MODE_FILE)
  set(commit unknown)
  find_program(git git)
  if(git)
    # A source tree without history may lie inside someone else's repository: that one's commit is not ours.
    execute_process(COMMAND ${git} -C ${SOURCE} rev-parse --show-toplevel
                    OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    file(REAL_PATH "${SOURCE}" source)
    if(NOT failed)
      file(REAL_PATH "${top}" top)
    endif()
    if(NOT failed AND top STREQUAL source)
      execute_process(COMMAND ${git} -C ${SOURCE} rev-parse --short HEAD
                      OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
      if(NOT failed)
        set(commit ${hash})
        execute_process(COMMAND ${git} --no-optional-locks -C ${SOURCE} status --porcelain --untracked-files=no
                        OUTPUT_VARIABLE changes ERROR_QUIET)
        if(changes)
          string(APPEND commit -dirty)
        endif()
        # Of what is compiled, new files among it.
        set(rooms cmake CMakeLists.txt apps calibrate dem element model)
        execute_process(COMMAND ${git} --no-optional-locks -C ${SOURCE} diff --no-ext-diff --no-textconv --no-color HEAD
                                -- ${rooms} OUTPUT_VARIABLE changes ERROR_QUIET)
        execute_process(COMMAND ${git} -C ${SOURCE} ls-files --others --exclude-standard -- ${rooms}
                        OUTPUT_VARIABLE new_files OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
        if(new_files)
          string(REPLACE "\n" ";" new_files "${new_files}")
          foreach(new_file IN LISTS new_files)
            file(SHA1 "${SOURCE}/${new_file}" hash_of_file)
            string(APPEND changes "${new_file} ${hash_of_file}\n")
          endforeach()
        endif()
        if(changes)
          string(SHA1 changes "${changes}")
          string(SUBSTRING ${changes} 0 8 changes)
        endif()
      endif()
    endif()
  elseif(EXISTS ${SOURCE}/.git/HEAD)
    # A clone on a machine without git: the hash stands in a file. Whether files were changed since is not known.
    file(STRINGS ${SOURCE}/.git/HEAD head LIMIT_COUNT 1)
    if(head MATCHES "^ref: (.+)$")
      set(ref ${CMAKE_MATCH_1})
      set(head)
      if(EXISTS ${SOURCE}/.git/${ref})
        file(STRINGS ${SOURCE}/.git/${ref} head LIMIT_COUNT 1)
      elseif(EXISTS ${SOURCE}/.git/packed-refs)
        file(STRINGS ${SOURCE}/.git/packed-refs head REGEX " ${ref}$" LIMIT_COUNT 1)
      endif()
    endif()
    if(head MATCHES "^([0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f])")
      set(commit ${CMAKE_MATCH_1})
    endif()
  endif()
  file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT [[// Written by cmake/version.cmake at build time.
#pragma once

namespace grainlaw::build_info {

inline constexpr const char* version = "@VERSION@";
inline constexpr const char* commit = "@commit@";
inline constexpr const char* changes = "@changes@";

}  // namespace grainlaw::build_info
]])
  return()
endif()

# grainlaw_version(target): lets the target include "grainlaw_build_info.hpp".
function(grainlaw_version target)
  set(folder ${PROJECT_BINARY_DIR}/build_info)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  get_directory_property(options COMPILE_OPTIONS)
  string(JOIN " " options ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}} ${options})
  if(GRAINLAW_BATCHES)
    string(APPEND options " in batches")
  endif()
  string(REPLACE "\"" "'" options "${options}")
  set_property(SOURCE version.cpp PROPERTY COMPILE_DEFINITIONS "GRAINLAW_BUILD_OPTIONS=\"$<CONFIG> ${options}\"")
  add_custom_target(grainlaw_build_info
                    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
                            -DOUTPUT=${folder}/grainlaw_build_info.hpp
                            -P ${PROJECT_SOURCE_DIR}/cmake/version.cmake
                    BYPRODUCTS ${folder}/grainlaw_build_info.hpp
                    COMMENT "Looking up the commit" VERBATIM)
  add_dependencies(${target} grainlaw_build_info)
  target_include_directories(${target} PRIVATE ${folder})
endfunction()
