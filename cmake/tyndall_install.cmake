# What `cmake --install` puts where. Component Runtime: the programs, their manual pages, completion for
# shells, example scenes. Component Development: the three libraries with their headers, and the package
# that find_package(Tyndall) finds. tests/install builds a program against the result;
# tyndall_package.cmake makes Debian packages of it.

include(CMakePackageConfigHelpers)

set(doc_dir ${CMAKE_INSTALL_DATADIR}/doc/tyndall)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Tyndall)

# The worker lies beside the command, where tetrahedralize() looks for it first.
foreach(program tyndall tyndall-tetgen)
    if(TARGET ${program})
        install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT Runtime)
    endif()
endforeach()

# The manual and the completions come from the program itself. Leaks are no matter here, which a build
# with sanitizers would end with.
set(help_dir ${PROJECT_BINARY_DIR}/help)
file(MAKE_DIRECTORY ${help_dir})
find_program(TYNDALL_GZIP gzip)
set(help_files "")
function(tyndall_help_file name destination)
    add_custom_command(OUTPUT ${help_dir}/${name}
        COMMAND ${CMAKE_COMMAND} -E env ASAN_OPTIONS=detect_leaks=0 $<TARGET_FILE:tyndall> ${ARGN} > ${help_dir}/${name}
        DEPENDS tyndall COMMENT "Asking tyndall for ${name}" VERBATIM)
    set(help_files ${help_files} ${help_dir}/${name} PARENT_SCOPE)
    if(destination)
        get_filename_component(folder ${destination} DIRECTORY)
        get_filename_component(installed ${destination} NAME)
        install(FILES ${help_dir}/${name} DESTINATION ${folder} RENAME ${installed} COMPONENT Runtime OPTIONAL)
    endif()
endfunction()
# tyndall_manual(FILE): installed compressed, as distributions do, where that can be done.
function(tyndall_manual file)
    get_filename_component(name ${file} NAME)
    if(NOT TYNDALL_GZIP)
        install(FILES ${file} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT Runtime OPTIONAL)
        return()
    endif()
    add_custom_command(OUTPUT ${help_dir}/${name}.gz
        COMMAND ${TYNDALL_GZIP} -9nc ${file} > ${help_dir}/${name}.gz DEPENDS ${file} VERBATIM)
    set(help_files ${help_files} ${help_dir}/${name}.gz PARENT_SCOPE)
    install(FILES ${help_dir}/${name}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT Runtime OPTIONAL)
endfunction()
tyndall_help_file(tyndall.1 "" man)
tyndall_help_file(tyndall.bash ${CMAKE_INSTALL_DATADIR}/bash-completion/completions/tyndall completion bash)
tyndall_help_file(tyndall.zsh ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions/_tyndall completion zsh)
tyndall_help_file(tyndall.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d/tyndall.fish completion fish)
tyndall_manual(${help_dir}/tyndall.1)
tyndall_manual(${PROJECT_SOURCE_DIR}/packaging/tyndall-tetgen.1)
add_custom_target(tyndall_help ALL DEPENDS ${help_files})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/scenes ${PROJECT_SOURCE_DIR}/examples/studies
        DESTINATION ${doc_dir}/examples COMPONENT Runtime)

install(TARGETS tyndall_mesh tyndall_radiosity tyndall_render EXPORT TyndallTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT Development)
install(EXPORT TyndallTargets NAMESPACE Tyndall:: DESTINATION ${package_dir} COMPONENT Development)
foreach(folder mesh radiosity render)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tyndall COMPONENT Development
            FILES_MATCHING PATTERN "*.h")
endforeach()

set(TYNDALL_WORKER_PATH ${CMAKE_INSTALL_BINDIR}/tyndall-tetgen)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/TyndallConfig.cmake.in
    ${PROJECT_BINARY_DIR}/TyndallConfig.cmake INSTALL_DESTINATION ${package_dir}
    PATH_VARS TYNDALL_WORKER_PATH)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/TyndallConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/TyndallConfig.cmake ${PROJECT_BINARY_DIR}/TyndallConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT Development)
# Debian has the text of the licence in a place of its own.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${doc_dir} COMPONENT Licence)
