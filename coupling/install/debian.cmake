# The Debian package: `cpack -G DEB`, or ./bootstrap package. One package holds the program, the
# Python module, the libraries and the documentation.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME grainfield)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "the grainfield authors <grainfield@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "discrete grains and continuum theories on the same points")
set(CPACK_PACKAGE_DESCRIPTION
"grainfield simulates grains (disks, polygons, spheres, superellipsoids),
averages their contact forces into stress and strain fields, evaluates
continuum models in closed form and with finite elements, fits their
constants, and reports which theory the grains support.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
set(CPACK_VERBATIM_VARIABLES ON)
# Where Debian's interpreter of any version looks.
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_BINARY_DIR}/debian_layout.cmake)
configure_file(debian_layout.cmake.in debian_layout.cmake @ONLY)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# Shared libraries, the two hundred of deal.II among them, are looked up by dpkg-shlibdeps.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(depends "gnuplot-nox | gnuplot")
if(GRAINFIELD_PYTHON)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  string(APPEND depends ", python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~)"
                        ", python3 (<< ${Python_VERSION_MAJOR}.${next}~), python3-numpy")
endif()
set(CPACK_DEBIAN_PACKAGE_DEPENDS ${depends})
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "openmpi-bin, python3-matplotlib")
# What who links the libraries needs.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "g++, cmake, libeigen3-dev, libfmt-dev, libsundials-dev, libhdf5-openmpi-dev, libopenmpi-dev, libtomlplusplus-dev, libpugixml-dev, libqhull-dev, paraview")
include(CPack)
