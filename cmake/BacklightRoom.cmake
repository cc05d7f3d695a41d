# backlight_room(NAME SOURCES file... [MAY_INCLUDE room...] [LIBRARIES target...])
#
# One room of the house (docs/architecture.md): the static library backlight_NAME with the public headers
# include/backlight/NAME. Each room's headers are reached through a folder of links of its own, so that
# #include "backlight/OTHER/..." compiles only where OTHER is in MAY_INCLUDE (or in what those may include).
function(backlight_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;MAY_INCLUDE;LIBRARIES" ${ARGN})
  set(door "${CMAKE_BINARY_DIR}/doors/${name}")
  file(MAKE_DIRECTORY "${door}/backlight")
  file(CREATE_LINK "${CMAKE_SOURCE_DIR}/include/backlight/${name}" "${door}/backlight/${name}" SYMBOLIC)

  add_library(backlight_${name} STATIC ${ROOM_SOURCES})
  target_include_directories(backlight_${name} PUBLIC "${door}" PRIVATE "${CMAKE_SOURCE_DIR}/src/${name}")
  target_link_libraries(backlight_${name} PUBLIC ${ROOM_LIBRARIES} PRIVATE $<BUILD_INTERFACE:backlight_compiler>)
  foreach(other ${ROOM_MAY_INCLUDE})
    if(NOT TARGET backlight_${other})
      message(FATAL_ERROR "Room ${name} may include ${other}, which is no room or comes after it")
    endif()
    target_link_libraries(backlight_${name} PUBLIC backlight_${other})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY BACKLIGHT_ROOMS backlight_${name})
endfunction()
