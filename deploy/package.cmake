# What is installed, and two Debian packages of it: traverse (the command line, for a person with a
# slicer, who wants no daemon) and traverse-server.
#
#   cmake --install build/release --prefix /usr        (DESTDIR is honoured)
#   cpack --config build/release/CPackConfig.cmake -B build/packages
include(GNUInstallDirs)

function(install_programs component)
  foreach(program IN LISTS ARGN)
    if(TARGET ${program})
      install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component})
      # The names of files in it are those of the project, wherever that lies: the same bytes from any folder.
      target_compile_options(${program} PRIVATE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
      # Which members of which archives it is made of; release/linked.py and image-root.sh read that.
      if(NOT APPLE)
        target_link_options(${program} PRIVATE LINKER:-Map=$<TARGET_FILE:${program}>.map)
      endif()
    endif()
  endforeach()
endfunction()
install_programs(client traverse traverse-loadgen)
install_programs(server traverse-server traverse-gateway traverse-health-probe)

# The API and the examples, for authors of schedulers.
set(PROTO ${CMAKE_INSTALL_DATADIR}/traverse/proto)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/proto/traverse DESTINATION ${PROTO} COMPONENT client
        FILES_MATCHING PATTERN *.proto)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/server/proto/google DESTINATION ${PROTO} COMPONENT client)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/traverse COMPONENT client
        USE_SOURCE_PERMISSIONS
        PATTERN node_modules EXCLUDE PATTERN generated EXCLUDE PATTERN __pycache__ EXCLUDE)

# For operators. The unit names /usr/bin and /etc, so it goes where those are.
install(FILES systemd/traverse-server.service systemd/traverse-gateway.service DESTINATION /lib/systemd/system COMPONENT server)
install(FILES systemd/server.flags systemd/gateway.flags DESTINATION /etc/traverse COMPONENT server)
install(FILES monitoring/rules/recording.yml monitoring/rules/alerts.yml monitoring/dashboard/traverse.json
        DESTINATION ${CMAKE_INSTALL_DATADIR}/traverse-server/monitoring COMPONENT server)
install(PROGRAMS monitoring/render_dashboard.py
        DESTINATION ${CMAKE_INSTALL_DATADIR}/traverse-server/monitoring COMPONENT server)

# Documentation where Debian expects it.
set(CHANGELOG ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz)
execute_process(COMMAND gzip -9nc ${CMAKE_CURRENT_SOURCE_DIR}/debian/changelog
                OUTPUT_FILE ${CHANGELOG} COMMAND_ERROR_IS_FATAL ANY)
traverse_list_archive_packages(ARCHIVE_PACKAGES)
foreach(component IN ITEMS client server)
  set(package traverse)
  if(component STREQUAL server)
    set(package traverse-server)
  endif()
  set(DOC ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES debian/copyright ${CHANGELOG} DESTINATION ${DOC} COMPONENT ${component})
  # The licences of what is linked from archives ask for a copy.
  foreach(archived IN LISTS ARCHIVE_PACKAGES)
    install(FILES /usr/share/doc/${archived}/copyright DESTINATION ${DOC}/archives RENAME ${archived}
            COMPONENT ${component} OPTIONAL)
  endforeach()
endforeach()
install(FILES README.md RUNBOOK.md CAPACITY.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/traverse-server
        COMPONENT server)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME traverse)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_VENDOR Traverse)
set(CPACK_PACKAGE_CONTACT "Traverse developers <traverse@users.noreply.github.com>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL client server)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION misc)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_CLIENT_PACKAGE_NAME traverse)
set(CPACK_COMPONENT_CLIENT_DESCRIPTION "shortens the travel moves of 3D printers
Reorders the paths within each layer of sliced G-code, so that the head
travels less while the same is printed, and proves the result equivalent
before it writes. Runs by itself, as a slicer's post-processing script, or
as a client of traverse-server.")
set(CPACK_DEBIAN_CLIENT_PACKAGE_SUGGESTS traverse-server)

set(CPACK_DEBIAN_SERVER_PACKAGE_NAME traverse-server)
set(CPACK_COMPONENT_SERVER_DESCRIPTION "route optimiser for 3D print farms
A gRPC service that takes the layers of a print and streams back shorter
routes through their paths, with deadlines, fair scheduling and metrics.
Listens on the loopback interface until told otherwise. With it comes
traverse-gateway, which takes sliced files over HTTP and gRPC; systemctl
enable --now traverse-gateway starts it.")
set(CPACK_DEBIAN_SERVER_PACKAGE_DEPENDS "adduser, init-system-helpers (>= 1.54~)")
set(CPACK_DEBIAN_SERVER_PACKAGE_SECTION net)
set(CPACK_DEBIAN_SERVER_PACKAGE_CONTROL_EXTRA
    ${CMAKE_CURRENT_SOURCE_DIR}/debian/conffiles ${CMAKE_CURRENT_SOURCE_DIR}/debian/postinst
    ${CMAKE_CURRENT_SOURCE_DIR}/debian/prerm ${CMAKE_CURRENT_SOURCE_DIR}/debian/postrm)
set(CPACK_DEBIAN_SERVER_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
