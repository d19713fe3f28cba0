# Debian packages by `cpack -G DEB`: strake (programs), libstrake-dev (library), python3-strake.
set(CPACK_GENERATOR DEB)
# Who builds a package is its maintainer, as Debian's own tools have it: DEBFULLNAME and DEBEMAIL. Strake has no
# public address; root@localhost is what packages for one's own machines carry.
set(contact_name "$ENV{DEBFULLNAME}")
set(contact_address "$ENV{DEBEMAIL}")
if(NOT contact_name OR NOT contact_address)
  set(contact_name "Local build of strake")
  set(contact_address "root@localhost")
endif()
set(CPACK_PACKAGE_CONTACT "${contact_name} <${contact_address}>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs development)
if(TARGET strake_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME strake)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "ninja-build")
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION "Programs that remesh surfaces with quads along their curvature.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libstrake-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libeigen3-dev, libembree-dev, libfmt-dev, libgeos-dev, libopenmesh-dev, libtbb-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Library and headers of the remesher strake.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-strake)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3, python3-numpy")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Python module of the remesher strake, on numpy arrays.")

foreach(package strake libstrake-dev python3-strake)
  string(REPLACE "python3-strake" python component ${package})
  string(REPLACE "libstrake-dev" development component ${component})
  string(REGEX REPLACE "^strake$" programs component ${component})
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} RENAME copyright
          COMPONENT ${component})
endforeach()
include(CPack)
