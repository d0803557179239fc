# Settings that every target of the house shares, and the one way to add a folder's library.

include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release)
endif()
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    find_program(TYNDALL_CCACHE ccache)
    if(TYNDALL_CCACHE)
        set(CMAKE_CXX_COMPILER_LAUNCHER ${TYNDALL_CCACHE})
    endif()
endif()
# A compiler cache does better file by file; there a file that lacks an include shows, too.
if(CMAKE_CXX_COMPILER_LAUNCHER)
    set(grouped OFF)
else()
    set(grouped ON)
endif()
option(TYNDALL_GROUPED "Compile the files of a folder in groups, and the headers that most read once" ${grouped})

add_library(tyndall_options INTERFACE)
# -ffp-contract=off: the walk's edge tests must be antisymmetric to the last bit (mesh/walk.h), and
# results must not depend on whether the machine has fused multiply-add.
target_compile_options(tyndall_options INTERFACE -Wall -Wextra -ffp-contract=off
                       $<$<BOOL:${TYNDALL_WERROR}>:-Werror>)
# GCC collects its garbage when 128 MB are full, and few files need more than 500: a tenth less time.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(tyndall_options INTERFACE "SHELL:--param ggc-min-heapsize=524288")
endif()

# For what reads, writes and asks but computes little: a third less time in the compiler.
add_library(tyndall_quick_compile INTERFACE)
target_compile_options(tyndall_quick_compile INTERFACE $<$<CONFIG:Release>:-O1>)

# tyndall_grouped(TARGET HEADERS...): with TYNDALL_GROUPED the target's files are compiled some at a time,
# and before them the headers of libraries that most of them read.
function(tyndall_grouped target)
    if(TYNDALL_GROUPED)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
        target_precompile_headers(${target} PRIVATE <algorithm> <cmath> <filesystem> <functional> <map>
                                  <memory> <optional> <string> <vector> ${ARGN})
    endif()
endfunction()

# tyndall_library(FOLDER): the static library tyndall_FOLDER from FOLDER/*.cpp, include prefix "FOLDER/".
function(tyndall_library folder)
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
    file(GLOB headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
    list(FILTER sources EXCLUDE REGEX "_main\\.cpp$")
    add_library(tyndall_${folder} STATIC ${sources} ${headers})
    add_library(Tyndall::${folder} ALIAS tyndall_${folder})
    target_link_libraries(tyndall_${folder} PRIVATE $<BUILD_INTERFACE:tyndall_options>)
    target_include_directories(tyndall_${folder} PUBLIC
        $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tyndall>)
    target_compile_features(tyndall_${folder} PUBLIC cxx_std_20)
    target_compile_definitions(tyndall_${folder} PRIVATE TYNDALL_VERSION="${PROJECT_VERSION}")
    set_target_properties(tyndall_${folder} PROPERTIES EXPORT_NAME ${folder})
endfunction()

# tyndall_embed_texts(TARGET HEADER FUNCTION FILES...): the target has FUNCTION of HEADER, which gives
# the texts of the files by their names.
function(tyndall_embed_texts target header function)
    string(REGEX REPLACE "^.*::" "" name ${function})
    set(output ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
    add_custom_command(
        OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DHEADER=${header} -DFUNCTION=${function} "-DTEXTS=${ARGN}"
                -P ${PROJECT_SOURCE_DIR}/cmake/embed_texts.cmake
        DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/embed_texts.cmake
        COMMENT "Embedding texts: ${name}" VERBATIM)
    target_sources(${target} PRIVATE ${output})
endfunction()
