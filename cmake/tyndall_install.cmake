# What `cmake --install` puts where: the programs, the three libraries with their headers, and the
# package that find_package(Tyndall) finds. tests/install builds a program against the result.

include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Tyndall)

# The worker lies beside the command, where tetrahedralize() looks for it first.
foreach(program tyndall tyndall-tetgen)
    if(TARGET ${program})
        install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    endif()
endforeach()

install(TARGETS tyndall_mesh tyndall_radiosity tyndall_render EXPORT TyndallTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT TyndallTargets NAMESPACE Tyndall:: DESTINATION ${package_dir})
foreach(folder mesh radiosity render)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tyndall FILES_MATCHING PATTERN "*.h")
endforeach()

set(TYNDALL_WORKER_PATH ${CMAKE_INSTALL_BINDIR}/tyndall-tetgen)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/TyndallConfig.cmake.in
    ${PROJECT_BINARY_DIR}/TyndallConfig.cmake INSTALL_DESTINATION ${package_dir}
    PATH_VARS TYNDALL_WORKER_PATH)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/TyndallConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/TyndallConfig.cmake ${PROJECT_BINARY_DIR}/TyndallConfigVersion.cmake
        DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
