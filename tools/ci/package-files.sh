#!/bin/sh
# Writes the pkg-config file and the CMake package of what `make install` puts in place. package-files.sh PREFIX LIBDIR
set -eu
prefix=$1
libdir=$2
version=$(sed -n 's/.*TALUS_VERSION "\(.*\)"/\1/p' include/talus/version.h)

sed -e "s|@CMAKE_INSTALL_PREFIX@|$prefix|" -e "s|@CMAKE_INSTALL_LIBDIR@|lib|" -e "s|@CMAKE_INSTALL_INCLUDEDIR@|include|" \
    -e "s|@PROJECT_VERSION@|$version|" tools/ci/talus.pc.in >"$libdir/pkgconfig/talus.pc"

cat >"$libdir/cmake/talus/talus-config.cmake" <<'END'
# Found from where this file lies, so that the tree may be moved.
get_filename_component(talus_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT TARGET talus::talus)
    add_library(talus::talus STATIC IMPORTED)
    set_target_properties(talus::talus PROPERTIES
        IMPORTED_LOCATION "${talus_prefix}/lib/libtalus.a"
        INTERFACE_INCLUDE_DIRECTORIES "${talus_prefix}/include"
        INTERFACE_LINK_LIBRARIES m)
endif()
END
cat >"$libdir/cmake/talus/talus-config-version.cmake" <<END
set(PACKAGE_VERSION $version)
string(REGEX MATCH "^[0-9]+[.][0-9]+" talus_ours "\${PACKAGE_VERSION}")
string(REGEX MATCH "^[0-9]+[.][0-9]+" talus_asked "\${PACKAGE_FIND_VERSION}")
if(talus_ours STREQUAL talus_asked AND NOT PACKAGE_VERSION VERSION_LESS PACKAGE_FIND_VERSION)
    set(PACKAGE_VERSION_COMPATIBLE TRUE)
    if(PACKAGE_VERSION STREQUAL PACKAGE_FIND_VERSION)
        set(PACKAGE_VERSION_EXACT TRUE)
    endif()
endif()
END
