# Tests in batches: what many files instantiate alike, GoogleTest's templates and JSON's, is compiled once for all files of
# a batch, which takes less than half the time. What a file keeps to itself, in its unnamed namespace, stays apart: the namespace gets a name.

# grainlaw_batches(VARIABLE room SOURCES…): sets the variable to files that hold six of the sources each. Messages of the
# compiler and of tests name the sources and their lines.
function(grainlaw_batches variable room)
  list(LENGTH ARGN count)
  math(EXPR last "${count} - 1")
  set(batches "")
  foreach(first RANGE 0 ${last} 6)
    list(SUBLIST ARGN ${first} 6 sources)
    set(text "")
    foreach(source IN LISTS sources)
      get_filename_component(name ${source} NAME_WE)
      file(READ ${source} content)
      string(REPLACE "\nnamespace {\n" "\nnamespace in_${name} {\n" content "${content}")
      string(APPEND text "#line 1 \"${source}\"\n${content}\n")
    endforeach()
    set(batch ${CMAKE_CURRENT_BINARY_DIR}/batches/${room}_${first}.cpp)
    file(WRITE ${batch}.new "${text}")
    configure_file(${batch}.new ${batch} COPYONLY)  # leaves an equal file as old as it is
    list(APPEND batches ${batch})
  endforeach()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARGN})
  set(${variable} ${batches} PARENT_SCOPE)
endfunction()
