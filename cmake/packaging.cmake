# `cmake --install` gives a tree that may be moved (nothing in it knows its own path); `cpack` makes a .deb of it.
install(TARGETS meniscus RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES README.md LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/meniscus)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/meniscus RENAME copyright)  # Debian Policy 12.5
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/meniscus OPTIONAL)
install(DIRECTORY molecules DESTINATION ${CMAKE_INSTALL_DATADIR}/meniscus)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME meniscus)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "Meniscus developers")
set(CPACK_PACKAGE_CONTACT "Meniscus developers <noreply@example.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"molecular renderer with ray-cast atoms, bonds and surfaces
Draws proteins, nucleic acids and small molecules from PDB and mmCIF files as
spheres, balls and sticks, or metaball surfaces, on a GPU or without one.")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # the linked libraries; below, those that are opened at run time:
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libosmesa6, fonts-dejavu-core")
include(CPack)
