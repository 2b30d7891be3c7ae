# The Debian packages that scripts/package makes with CPack, one a component of TraverseInstall.cmake:
#   traverse      for those who run it; what it depends on is found by dpkg-shlibdeps
#   traverse-dev  for those who write programs with its libraries: 24 MB of static libraries and a
#                 gigabyte of other projects' -dev packages, which the former need not have
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME traverse)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "The Traverse authors")
set(CPACK_PACKAGE_CONTACT "The Traverse authors <authors@traverse.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/package)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME traverse)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
  "One command takes a recording (MRPT rawlog, KITTI, point clouds) to a trajectory, a map,
pictures and one self-contained HTML report that a reviewer can audit.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
# Nothing links the font that pictures are labelled in, nor what is loaded when a bag or a capture needs it.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS
  "fonts-dejavu-core, libbz2-1.0, liblz4-1, libpcap0.8, libsqlite3-0, libzstd1")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "bash-completion, man-db, slurm-client, xvfb")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME traverse-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "Headers, static libraries and TraverseConfig.cmake: find_package(Traverse) in a project of your own.
Examples stand in /usr/share/doc/traverse/examples.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
# What TraverseDependencies.cmake finds, and the files that runs and reports are made with.
string(JOIN ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "traverse (= ${PROJECT_VERSION})"
  libceres-dev libcairo2-dev libeigen3-dev libembree-dev libfmt-dev libgeographiclib-dev liblzf-dev
  libmrpt-maps-dev libmrpt-obs-dev libopencv-contrib-dev libopencv-dev libosmesa6-dev libssl-dev
  libtbb-dev libyaml-cpp-dev pkg-config zlib1g-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cmake, g++")

include(CPack)
