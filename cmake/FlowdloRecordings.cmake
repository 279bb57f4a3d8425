# FLOWDLO_BUILD_RECORDINGS: ROS 1 bags are read by rosbag_storage. AUTO reads them where it is installed.
# Leaves the target flowdlo_rosbag behind, or FLOWDLO_RECORDINGS_LACK, a sentence that says why not.
set(FLOWDLO_BUILD_RECORDINGS AUTO CACHE STRING
    "Read ROS 1 bags: AUTO (where rosbag_storage is), ON or OFF")
set_property(CACHE FLOWDLO_BUILD_RECORDINGS PROPERTY STRINGS AUTO ON OFF)

set(FLOWDLO_RECORDINGS_LACK "it was built with FLOWDLO_BUILD_RECORDINGS=OFF")
if(FLOWDLO_BUILD_RECORDINGS)
  # Its own package files ask for more than a reader needs, some of it missing on Debian: looked for
  # by hand. The second names are where the headers of its plugin loader lie on Debian.
  set(found_all TRUE)
  set(include_dirs)
  foreach(header rosbag/bag.h sensor_msgs/Image.h pluginlib/class_loader.hpp
                 class_loader/class_loader.hpp rcpputils/shared_library.hpp rcutils/logging.h
                 ament_index_cpp/get_resource.hpp)
    string(MAKE_C_IDENTIFIER "${header}" name)
    get_filename_component(package "${header}" DIRECTORY)
    find_path(FLOWDLO_ROS_${name} "${header}" PATH_SUFFIXES "${package}")
    mark_as_advanced(FLOWDLO_ROS_${name})
    if(FLOWDLO_ROS_${name})
      list(APPEND include_dirs "${FLOWDLO_ROS_${name}}")
    endif()
  endforeach()
  set(libraries)
  foreach(library rosbag_storage roscpp_serialization rostime cpp_common class_loader console_bridge)
    find_library(FLOWDLO_ROS_${library}_LIBRARY ${library})
    mark_as_advanced(FLOWDLO_ROS_${library}_LIBRARY)
    if(FLOWDLO_ROS_${library}_LIBRARY)
      list(APPEND libraries "${FLOWDLO_ROS_${library}_LIBRARY}")
    else()
      set(found_all FALSE)
    endif()
  endforeach()
  list(REMOVE_DUPLICATES include_dirs)

  if(found_all AND FLOWDLO_ROS_rosbag_bag_h AND FLOWDLO_ROS_sensor_msgs_Image_h)
    include(CheckCXXSourceCompiles)
    set(CMAKE_REQUIRED_INCLUDES ${include_dirs})
    set(CMAKE_REQUIRED_LIBRARIES ${libraries})
    set(CMAKE_REQUIRED_FLAGS "-std=c++17")
    check_cxx_source_compiles("
      #include <rosbag/bag.h>
      #include <rosbag/view.h>
      #include <sensor_msgs/Image.h>
      int main() {
        rosbag::Bag bag;
        rosbag::View view(bag);
        return view.begin()->instantiate<sensor_msgs::Image>() ? 0 : 1;
      }" FLOWDLO_ROSBAG_WORKS)
    unset(CMAKE_REQUIRED_INCLUDES)
    unset(CMAKE_REQUIRED_LIBRARIES)
    unset(CMAKE_REQUIRED_FLAGS)
  endif()
  set(FLOWDLO_RECORDINGS_LACK "rosbag_storage was not found when it was built")
  if(FLOWDLO_ROSBAG_WORKS)
    add_library(flowdlo_rosbag INTERFACE)
    target_include_directories(flowdlo_rosbag SYSTEM INTERFACE ${include_dirs})
    target_link_libraries(flowdlo_rosbag INTERFACE ${libraries})
  elseif(FLOWDLO_BUILD_RECORDINGS STREQUAL "AUTO")
    message(STATUS "Recordings are left out: rosbag_storage was not found; install "
                   "librosbag-storage-dev and libsensor-msgs-dev to read ROS 1 bags")
  else()
    message(FATAL_ERROR "FLOWDLO_BUILD_RECORDINGS: expected rosbag_storage and sensor_msgs, found "
                        "none that works; install librosbag-storage-dev and libsensor-msgs-dev, or "
                        "set it to AUTO or OFF")
  endif()
endif()
