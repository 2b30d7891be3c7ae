# Fails if the library links to an OpenGL function by name: it must ask OSMesa for each, so that
# another OpenGL may live in the same process.
execute_process(COMMAND ${NM} --undefined-only ${LIBRARY} OUTPUT_VARIABLE symbols
                COMMAND_ERROR_IS_FATAL ANY)
if(NOT symbols MATCHES "OSMesaGetProcAddress")
  message(FATAL_ERROR "${LIBRARY} does not look like the renderer")
endif()
if(symbols MATCHES " gl[A-Z][A-Za-z0-9]*")
  message(FATAL_ERROR "${LIBRARY} links to${CMAKE_MATCH_0}")
endif()
