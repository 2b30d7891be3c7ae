# What `cmake --install` puts where. Two components:
#   runtime      the programs, their files, manual pages, completion of command lines
#   development  headers, static libraries, TraverseConfig.cmake, examples
# Libraries and programs say themselves that they are installed; here is what belongs to all.
include(CMakePackageConfigHelpers)

set(share ${CMAKE_INSTALL_DATADIR}/traverse)
file(GLOB share_folders CONFIGURE_DEPENDS LIST_DIRECTORIES true ${CMAKE_SOURCE_DIR}/share/*)

# Programs look for their files in ../share/traverse from where they are: see installed_files.hpp. For
# those in the build tree it stands there too, made of links.
set(linked ${CMAKE_BINARY_DIR}/apps/share/traverse)
file(REMOVE_RECURSE ${linked})
file(MAKE_DIRECTORY ${linked})
foreach(folder IN LISTS share_folders ITEMS ${CMAKE_SOURCE_DIR}/reports/templates)
  cmake_path(GET folder FILENAME name)
  file(CREATE_LINK ${folder} ${linked}/${name} SYMBOLIC)
endforeach()

install(DIRECTORY ${share_folders} ${CMAKE_SOURCE_DIR}/reports/templates
        DESTINATION ${share} COMPONENT runtime)
if(EXISTS ${CMAKE_SOURCE_DIR}/LICENSE)
  install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright
          COMPONENT runtime)  # where Debian looks for it
endif()
foreach(text IN ITEMS README.md CHANGELOG.md THIRD_PARTY.md CITATION.cff)
  if(EXISTS ${CMAKE_SOURCE_DIR}/${text})
    install(FILES ${CMAKE_SOURCE_DIR}/${text} DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
  endif()
endforeach()

# Manual pages and completion come from the programs themselves, hence from the options they take.
set(made ${CMAKE_BINARY_DIR}/apps/documentation)
set(completions)
foreach(program IN ITEMS traverse traverse-replay)
  add_custom_command(OUTPUT ${made}/${program}.bash
    COMMAND ${CMAKE_COMMAND} -E make_directory ${made}
    COMMAND ${program} --bash-completion > ${made}/${program}.bash
    DEPENDS ${program} VERBATIM)
  list(APPEND completions ${made}/${program}.bash)
  install(FILES ${made}/${program}.bash RENAME ${program} COMPONENT runtime
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
endforeach()
add_custom_command(OUTPUT ${made}/man1/traverse.1.gz
  COMMAND ${CMAKE_SOURCE_DIR}/scripts/man-pages ${PROJECT_VERSION} ${made}/man1
          $<TARGET_FILE:traverse> $<TARGET_FILE:traverse-replay>
  DEPENDS ${CMAKE_SOURCE_DIR}/scripts/man-pages traverse traverse-replay
  COMMENT "Manual pages from --help" VERBATIM)
install(DIRECTORY ${made}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT runtime)
if(NOT TRAVERSE_SANITIZE)
  add_custom_target(documentation ALL DEPENDS ${completions} ${made}/man1/traverse.1.gz)
endif()

# For find_package(Traverse).
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Traverse)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/TraverseConfig.cmake.in
  ${CMAKE_BINARY_DIR}/TraverseConfig.cmake
  INSTALL_DESTINATION ${package} PATH_VARS share)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/TraverseConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/TraverseConfig.cmake ${CMAKE_BINARY_DIR}/TraverseConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/TraverseDependencies.cmake
        DESTINATION ${package} COMPONENT development)
install(EXPORT TraverseTargets NAMESPACE Traverse:: DESTINATION ${package} COMPONENT development)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT development)
install(FILES ${CMAKE_SOURCE_DIR}/docs/library.md DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT development)
