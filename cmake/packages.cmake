# Debian packages: one for each part that is installed. `./dev package` makes them, `cpack` in any build folder, too.
#
#   libhaptel0.1           runtime                libhaptel-dev           development
#   libhaptel-compiler0.1  compiler               libhaptel-compiler-dev  compiler_development
#   haptel                 tools                  python3-haptel          python
#   haptel-materials       materials              haptel-udev             udev
#
# A library's package holds nothing but the library of its SONAME, so that those of two versions go together. What a
# program is built with needs exactly the library of its own build. What other packages are needed comes from
# dpkg-shlibdeps: packages are made on the Debian release that they are for, and their version names it, so that an
# upgrade of Debian takes the ones that were made for the newer release.
if(NOT TARGET haptel_public OR NOT HAPTEL_TOOLS)
    return()
endif()
set(HAPTEL_MAINTAINER "The authors of Haptel <haptel@haptel.invalid>" CACHE STRING "Whom the packages name as their maintainer")

set(system) # debian12, ubuntu24.04
foreach(part ID VERSION_ID)
    if(EXISTS /etc/os-release)
        file(STRINGS /etc/os-release line REGEX "^${part}=")
        string(REGEX REPLACE ".*=|\"" "" line "${line}")
        string(APPEND system "${line}")
    endif()
endforeach()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME haptel)
set(CPACK_PACKAGE_VENDOR Haptel)
set(CPACK_PACKAGE_CONTACT ${HAPTEL_MAINTAINER})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1~${system})
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/packages_need.cmake)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/api) # the one library needs the other
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(package_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(package_so ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(package_files ${PROJECT_BINARY_DIR}/package_files)
set(package_text "Haptel is a language and a runtime for textures you can touch, written like\n\
shaders: from a point on a surface to a height in metres, which a haptic device\n\
makes felt.")
configure_file(cmake/copyright.in ${package_files}/copyright @ONLY)
string(TIMESTAMP package_date "%a, %d %b %Y %H:%M:%S +0000" UTC) # or that of SOURCE_DATE_EPOCH

# haptel_package(COMPONENT NAME SECTION SUMMARY TEXT [ALL] [DEPENDS NAME...] [RECOMMENDS NAME...] [SUGGESTS NAME...])
function(haptel_package component name section summary text)
    cmake_parse_arguments(ARG ALL "" "DEPENDS;RECOMMENDS;SUGGESTS" ${ARGN})
    set(files ${package_files}/${name})
    file(WRITE ${files}/changelog.Debian "haptel (${package_version}) stable; urgency=medium\n\n"
        "  * Made by cpack. What has changed stands beside this file, in changelog.gz.\n\n"
        " -- ${HAPTEL_MAINTAINER}  ${package_date}\n")
    configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${files}/changelog COPYONLY)
    execute_process(COMMAND gzip -9nf ${files}/changelog ${files}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
    install(FILES ${package_files}/copyright ${files}/changelog.gz ${files}/changelog.Debian.gz
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component} EXCLUDE_FROM_ALL)

    string(TOUPPER ${component} part)
    foreach(field DEPENDS RECOMMENDS SUGGESTS)
        list(JOIN ARG_${field} ", " names)
        set(CPACK_DEBIAN_${part}_PACKAGE_${field} "${names}" PARENT_SCOPE)
    endforeach()
    set(CPACK_DEBIAN_${part}_PACKAGE_NAME ${name} PARENT_SCOPE)
    set(CPACK_DEBIAN_${part}_PACKAGE_SECTION ${section} PARENT_SCOPE)
    set(CPACK_DEBIAN_${part}_DESCRIPTION "${summary}\n${package_text}\n\n${text}" PARENT_SCOPE)
    if(ARG_ALL)
        set(CPACK_DEBIAN_${part}_PACKAGE_ARCHITECTURE all PARENT_SCOPE)
        set(CPACK_DEBIAN_${part}_PACKAGE_SHLIBDEPS OFF PARENT_SCOPE)
    endif()
    if(section STREQUAL libs) # tells dpkg-shlibdeps of other packages the name, and ldconfig of the library
        string(REPLACE - _ library ${name})
        string(REGEX REPLACE "[0-9.]+$" "" library ${library})
        file(WRITE ${files}/shlibs "${library} ${package_so} ${name} (>= ${PROJECT_VERSION})\n")
        # cpack calls ldconfig besides, in scripts that cannot be left out
        file(WRITE ${files}/triggers "activate-noawait ldconfig\n")
        set(CPACK_DEBIAN_${part}_PACKAGE_CONTROL_EXTRA ${files}/shlibs ${files}/triggers PARENT_SCOPE)
    endif()
    set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
endfunction()

# The manual page of the command says what its --help does.
add_custom_command(OUTPUT ${package_files}/haptel.1.gz
    COMMAND sh -c "'$<TARGET_FILE:haptel>' --help | awk -v version=${PROJECT_VERSION} -f '${PROJECT_SOURCE_DIR}/cmake/manual_page.awk' | gzip -9n > haptel.1.gz"
    DEPENDS haptel ${PROJECT_SOURCE_DIR}/cmake/manual_page.awk WORKING_DIRECTORY ${package_files} VERBATIM)
add_custom_target(haptel_manual_page ALL DEPENDS ${package_files}/haptel.1.gz)
install(FILES ${package_files}/haptel.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools OPTIONAL)

set(of_this_build "(= ${package_version})")
set(CPACK_COMPONENTS_ALL)
haptel_package(runtime libhaptel${package_so} libs
    "textures you can touch, written like shaders: the runtime"
    "This library has scenes, contact, force, devices and the loop that runs a\n\
thousand times a second. It needs no compiler: textures may be compiled ahead\n\
of time."
    RECOMMENDS haptel-udev)
haptel_package(compiler libhaptel-compiler${package_so} libs
    "textures you can touch, written like shaders: the compiler"
    "This library turns textures into machine code while they are felt."
    DEPENDS "libhaptel${package_so} ${of_this_build}" SUGGESTS haptel-materials)
haptel_package(development libhaptel-dev libdevel
    "textures you can touch, written like shaders: headers"
    "These are the headers for programs in C++ and C, and what CMake and pkg-config\n\
need to find the library. With the package haptel, textures are compiled when a\n\
program is built."
    DEPENDS "libhaptel${package_so} ${of_this_build}" RECOMMENDS haptel SUGGESTS libhaptel-compiler-dev)
haptel_package(compiler_development libhaptel-compiler-dev libdevel
    "textures you can touch, written like shaders: to link the compiler"
    "With this package a program compiles textures while it runs."
    DEPENDS "libhaptel-compiler${package_so} ${of_this_build}" "libhaptel-dev ${of_this_build}")
haptel_package(python python3-haptel python
    "textures you can touch, written like shaders: Python module"
    "The module haptel evaluates textures at many points, and builds and runs\n\
scenes."
    ALL DEPENDS "python3 (>= 3.9)" "libhaptel${package_so} (>= ${PROJECT_VERSION})"
    "libhaptel-compiler${package_so} (>= ${PROJECT_VERSION})" SUGGESTS python3-numpy)
haptel_package(tools haptel devel
    "textures you can touch, written like shaders: the command"
    "The command checks, draws, measures and compiles textures, and explores scenes\n\
with a simulated hand or a haptic device."
    RECOMMENDS haptel-materials haptel-udev fonts-dejavu-core)
haptel_package(materials haptel-materials science
    "textures you can touch, written like shaders: materials"
    "This is a library of textures that are true to measured materials, each with\n\
its source: metals, woods, fabrics, skins."
    ALL SUGGESTS haptel)
haptel_package(udev haptel-udev misc
    "textures you can touch, written like shaders: rules for devices"
    "With these rules of udev whoever sits at the computer may open its haptic\n\
devices."
    ALL SUGGESTS haptel)
include(CPack)
