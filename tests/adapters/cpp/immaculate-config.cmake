include(CMakeFindDependencyMacro)
find_dependency(nlohmann_json 3.9)
include(${CMAKE_CURRENT_LIST_DIR}/immaculate-targets.cmake)
