# haptel_code_version(NAMESPACE SOURCES [LIBRARIES]): sets `code_version` to a source that defines
# NAMESPACE::code_version, a hash of the sources and of what they are compiled with (compiler, flags, versions of
# libraries), so that what another version has made and kept on disk is never taken for its own.
if(NOT CMAKE_SCRIPT_MODE_FILE)
    set(HAPTEL_CODE_VERSION ${CMAKE_CURRENT_LIST_FILE})
    function(haptel_code_version namespace sources)
        list(APPEND sources ${PROJECT_SOURCE_DIR}/cmake/haptel_target.cmake ${HAPTEL_CODE_VERSION})
        set(out ${CMAKE_CURRENT_BINARY_DIR}/code_version.cpp)
        string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
        set(compiled_with "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_SYSTEM_PROCESSOR} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} ${HAPTEL_SANITIZE} ${ARGN}")
        add_custom_command(
            OUTPUT ${out}
            COMMAND ${CMAKE_COMMAND} -DOUT=${out} "-DFILES=${sources}" "-DCOMPILED_WITH=${compiled_with}" -DNAMESPACE=${namespace} -P ${HAPTEL_CODE_VERSION}
            DEPENDS ${sources}
            VERBATIM)
        set(code_version ${out} PARENT_SCOPE)
    endfunction()
    return()
endif()

set(hashes "${COMPILED_WITH};")
foreach(file ${FILES})
    file(SHA256 ${file} hash)
    string(APPEND hashes ${hash})
endforeach()
string(SHA256 version "${hashes}")
file(WRITE ${OUT} "namespace ${NAMESPACE} {\nextern const char code_version[];\nconst char code_version[] = \"${version}\";\n}\n")
