# Installs BUILD into an empty PREFIX and looks whether everything of SOURCE that should be there is.
file(REMOVE_RECURSE ${PREFIX} ${CONSUMERS})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

foreach(room element dem model calibrate)
  file(GLOB_RECURSE headers RELATIVE ${SOURCE} ${SOURCE}/${room}/*.hpp)
  list(FILTER headers EXCLUDE REGEX "(snapshot_hdf5|-inl)[.]hpp$")  # private to the library
  foreach(header IN LISTS headers)
    if(NOT EXISTS ${PREFIX}/include/grainlaw/${header})
      message(SEND_ERROR "not installed: include/grainlaw/${header}")
    endif()
  endforeach()
endforeach()
if(NOT EXISTS ${PREFIX}/include/grainlaw.h)
  message(SEND_ERROR "not installed: include/grainlaw.h")
endif()
file(GLOB_RECURSE data RELATIVE ${SOURCE}/data ${SOURCE}/data/*)
list(FILTER data EXCLUDE REGEX "^records/|[.]py$")  # records of campaigns stay in the source tree
foreach(file IN LISTS data)
  if(NOT EXISTS ${PREFIX}/share/grainlaw/${file})
    message(SEND_ERROR "not installed: share/grainlaw/${file}")
  endif()
endforeach()
# The program runs from where it is installed, on data it was installed with, without the source folder's help.
execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=GRAINLAW_HOME ${PREFIX}/bin/grainlaw predict
                        ${PREFIX}/share/grainlaw/thesis/parameters.json ${PREFIX}/share/grainlaw/paths/uni.json
                        -o ${PREFIX}/uni.csv
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${PREFIX}/uni.csv header LIMIT_COUNT 1)
if(NOT header MATCHES "^segment,eps_vol,eps_dev,nu,P,")
  message(SEND_ERROR "uni.csv begins with '${header}'")
endif()
