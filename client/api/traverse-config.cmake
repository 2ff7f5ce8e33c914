# What traverse::client is linked with. gRPC's own package expects Protobuf to be found before it.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Protobuf)
find_dependency(absl CONFIG)
find_dependency(gRPC CONFIG)
include(${CMAKE_CURRENT_LIST_DIR}/traverse-targets.cmake)
