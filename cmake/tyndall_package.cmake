# Debian packages by CPack: `./bootstrap package`. tyndall: what a user runs; libtyndall-dev: what a C++
# program is built with. What they depend on is asked of the programs by dpkg-shlibdeps, and of
# TyndallConfig.cmake.in by whoever changes it.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tyndall)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")  # of both
set(CPACK_PACKAGE_VENDOR "The Tyndall developers")
set(CPACK_PACKAGE_CONTACT "The Tyndall developers <developers@tyndall.invalid>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL Runtime Development)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

find_program(TYNDALL_SHLIBDEPS dpkg-shlibdeps)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME tyndall)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
if(TYNDALL_SHLIBDEPS)
    set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
else()
    set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS OFF)
endif()
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "paraview, bash-completion")
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION
"Tyndall computes where light goes: radiosity for surfaces and for the media
between them (the zonal method), on a mesh that refines itself, without noise.
It makes pictures, pages to walk through in a browser, solutions for ParaView,
and figures: irradiance, net flux, exchange areas.
.
This package has the command tyndall, its manual, completion for shells, and
example scenes.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtyndall-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# Those of TyndallConfig.cmake.in. The programs: the worker is one of them.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "tyndall (= ${PROJECT_VERSION}), libglm-dev, libtbb-dev, libembree-dev, libfmt-dev, libhdf5-dev, libopenexr-dev, libpng-dev, libopenmesh-dev, libgmp-dev, libmpfr-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
"For C++ programs: static libraries, headers and the CMake package of Tyndall.
Meshes (mesh), light (radiosity), pictures (render).
.
In CMake: find_package(Tyndall) and the target Tyndall::render.")

# What Debian's policy asks for beside the files.
if(TYNDALL_GZIP)
    add_custom_command(OUTPUT ${help_dir}/changelog.gz
        COMMAND ${TYNDALL_GZIP} -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md > ${help_dir}/changelog.gz
        DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md VERBATIM)
    add_custom_target(tyndall_changelog ALL DEPENDS ${help_dir}/changelog.gz)
endif()
foreach(package tyndall libtyndall-dev)
    if(package STREQUAL tyndall)
        set(component Runtime)
    else()
        set(component Development)
    endif()
    install(FILES ${PROJECT_SOURCE_DIR}/packaging/copyright
            DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
    install(FILES ${help_dir}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
            COMPONENT ${component} OPTIONAL)
endforeach()

include(CPack)
