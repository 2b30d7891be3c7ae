# What only the build needs: libraries that are headers alone and included by sources, of which nothing
# is left to find for those who link Traverse's; what the programs use; what the tests use.
find_package(Boost REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(nanoflann REQUIRED)
find_package(tsl-robin-map REQUIRED)
find_path(TRAVERSE_HNSWLIB hnswlib/hnswlib.h REQUIRED)  # on the system's path
find_path(TRAVERSE_RANDOM123 Random123/philox.h REQUIRED)  # on the system's path
# Loaded when a bag needs them (libs/bags), by what their headers declare.
foreach(header IN ITEMS bzlib.h lz4frame.h sqlite3.h zstd.h)
  find_path(TRAVERSE_HEADER_${header} ${header} REQUIRED)
endforeach()
# Loaded when a capture needs it (libs/packets), by what its header declares.
find_path(TRAVERSE_HEADER_pcap pcap/pcap.h REQUIRED)

# TraverseTargets.cmake keeps these out of what the installed targets ask for.
set(TRAVERSE_HEADERS_ONLY
  Boost::headers nanoflann::nanoflann nlohmann_json::nlohmann_json tsl::robin_map)

find_package(CLI11 REQUIRED)
find_package(mrpt-gui REQUIRED)
find_package(mrpt-opengl REQUIRED)
find_package(OpenGL REQUIRED COMPONENTS OpenGL)

if(TRAVERSE_BUILD_TESTS)
  find_package(GTest REQUIRED)
  find_package(benchmark REQUIRED)
endif()
