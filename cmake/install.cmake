# Installation: libraries, headers, data and program; and the package that find_package(grainlaw) finds, one component
# per room. A component needs only what its own room needs.
include(CMakePackageConfigHelpers)
set(grainlaw_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/grainlaw)
set(grainlaw_data_dir ${CMAKE_INSTALL_DATADIR}/grainlaw)

set(grainlaw_rooms)
foreach(room element dem model calibrate)
  if(TARGET grainlaw_${room})
    list(APPEND grainlaw_rooms ${room})
    install(TARGETS grainlaw_${room} EXPORT grainlaw-${room} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(EXPORT grainlaw-${room} NAMESPACE grainlaw:: DESTINATION ${grainlaw_package_dir})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/grainlaw
            FILES_MATCHING PATTERN *.hpp
            PATTERN snapshot_hdf5.hpp EXCLUDE  # private: needs HDF5's headers
            PATTERN four-inl.hpp EXCLUDE)      # private: part of the kernels' source
  endif()
endforeach()
if(TARGET grainlaw_model)
  install(FILES ${PROJECT_SOURCE_DIR}/model/c/grainlaw.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endif()
if(TARGET grainlaw_program)
  install(TARGETS grainlaw_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/ DESTINATION ${grainlaw_data_dir} PATTERN *.py EXCLUDE
        PATTERN records EXCLUDE)  # of campaigns: for the tests and for readers of the source tree
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/grainlaw-config.cmake.in ${PROJECT_BINARY_DIR}/grainlaw-config.cmake
  INSTALL_DESTINATION ${grainlaw_package_dir} PATH_VARS grainlaw_data_dir)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/grainlaw-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/grainlaw-config.cmake ${PROJECT_BINARY_DIR}/grainlaw-config-version.cmake
        DESTINATION ${grainlaw_package_dir})
