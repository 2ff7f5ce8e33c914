# Links gRPC, Protobuf, Abseil and COIN-OR from their archives where these are installed beside the libraries, as in
# Debian's -dev packages. Of the 20 ms of CPU time that a short command took, 12 were the dynamic linker's, which
# looked up 31,000 symbols in a hundred libraries. OpenSSL stays a library: it gets security updates by itself. The
# images are built without archives: there the programs share the libraries.
#
# Include it behind the find_package calls, and call traverse_archive_package before a target of pkg-config is linked.
# traverse_list_archive_packages says whose code is then part of the programs, for their licences.
option(TRAVERSE_ARCHIVES "Link gRPC, Protobuf, Abseil and COIN-OR from archives where there are any" ON)
if(TRAVERSE_SANITIZE OR APPLE)
  set(TRAVERSE_ARCHIVES OFF)
endif()

# The archive beside a shared library; empty if there is none.
function(traverse_archive_beside library out)
  string(REGEX REPLACE "\\.so[.0-9]*$" ".a" archive "${library}")
  if(NOT archive STREQUAL library AND EXISTS ${archive})
    set_property(GLOBAL APPEND PROPERTY traverse_archives ${archive})
    set(${out} ${archive} PARENT_SCOPE)
  else()
    set(${out} "" PARENT_SCOPE)
  endif()
endfunction()

function(traverse_archive_imported)
  get_property(targets DIRECTORY ${PROJECT_SOURCE_DIR} PROPERTY IMPORTED_TARGETS)
  foreach(target IN LISTS targets)
    if(NOT target MATCHES "^(gRPC|protobuf|absl|c-ares)::")
      continue()
    endif()
    foreach(property IN ITEMS IMPORTED_LOCATION IMPORTED_LOCATION_NONE IMPORTED_LOCATION_RELEASE)
      get_target_property(library ${target} ${property})
      if(library)
        traverse_archive_beside(${library} archive)
        if(archive)
          set_target_properties(${target} PROPERTIES ${property} ${archive})
        endif()
      endif()
    endforeach()
  endforeach()
endfunction()

# What pkg_check_modules(... IMPORTED_TARGET ...) has found.
function(traverse_archive_package target)
  if(NOT TRAVERSE_ARCHIVES)
    return()
  endif()
  get_target_property(libraries ${target} INTERFACE_LINK_LIBRARIES)
  set(linked)
  foreach(library IN LISTS libraries)
    if(library MATCHES "/lib(Cbc|Cgl|Clp|Osi|CoinUtils)[A-Za-z]*\\.so$")
      traverse_archive_beside(${library} archive)
      if(archive)
        set(library ${archive})
      endif()
    endif()
    list(APPEND linked ${library})
  endforeach()
  set_target_properties(${target} PROPERTIES INTERFACE_LINK_LIBRARIES "${linked}")
endfunction()

# Call it at the end, when all archives are known.
function(traverse_list_archive_packages out)
  get_property(archives GLOBAL PROPERTY traverse_archives)
  find_program(TRAVERSE_DPKG_QUERY dpkg-query)
  set(packages)
  if(archives AND TRAVERSE_DPKG_QUERY)
    execute_process(COMMAND ${TRAVERSE_DPKG_QUERY} -S ${archives} OUTPUT_VARIABLE owners ERROR_QUIET)
    string(REGEX MATCHALL "[^\n]+" owners "${owners}")
    foreach(owner IN LISTS owners)
      string(REGEX REPLACE ":.*" "" owner ${owner})
      list(APPEND packages ${owner})
    endforeach()
    list(REMOVE_DUPLICATES packages)
    list(SORT packages)
  endif()
  set(${out} ${packages} PARENT_SCOPE)
endfunction()

if(TRAVERSE_ARCHIVES)
  traverse_archive_imported()
  # Libraries may be named in any order, archives may not: the linker goes round all of them.
  add_link_options(LINKER:--start-group)
  string(APPEND CMAKE_CXX_STANDARD_LIBRARIES " -Wl,--end-group")
endif()
