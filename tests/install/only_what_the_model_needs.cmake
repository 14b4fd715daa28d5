# Run in the consumer's project(): at its end, no package but these may have been found. OpenMP comes with the compiler,
# and it is SUNDIALS that looks for it.
function(check_packages_found)
  get_property(found GLOBAL PROPERTY PACKAGES_FOUND)
  list(REMOVE_ITEM found grainlaw nlohmann_json Eigen3 SUNDIALS OpenMP OpenMP_C OpenMP_CXX)
  if(found)
    message(FATAL_ERROR "component model also looked for: ${found}")
  endif()
endfunction()
cmake_language(DEFER CALL check_packages_found)
