# Installs the build in BUILD_DIR to a prefix inside it, then configures, builds and runs the program
# in SOURCE_DIR against that prefix, which is moved first: an installed package may be relocated.
set(work ${BUILD_DIR}/install_test)
file(REMOVE_RECURSE ${work})

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${work}/first)
file(RENAME ${work}/first ${work}/moved)
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${work}/build -G Ninja -DCMAKE_BUILD_TYPE=${BUILD_TYPE}
    "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" -DCMAKE_PREFIX_PATH=${work}/moved)
run(${CMAKE_COMMAND} --build ${work}/build)
execute_process(COMMAND ./user WORKING_DIRECTORY ${work}/build COMMAND_ERROR_IS_FATAL ANY)
if(NOT EXISTS ${work}/build/smoky_room.png)
    message(FATAL_ERROR "The program ran, but wrote no picture.")
endif()
run(${work}/moved/bin/tyndall --version)
