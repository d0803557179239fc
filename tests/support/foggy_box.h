// A small foggy box with a lamp, two cameras and quick settings.
#pragma once

namespace tyndall::test {

inline constexpr const char* foggy_box = R"(format = 1
title = "Foggy box"
[[material]]
name = "grey"
reflectance = 0.5
[[material]]
name = "lamp"
reflectance = 0.0
emission = 10.0
[[surface]]
name = "room"
material = "grey"
room = { min = [0,0,0], max = [2,2,2] }
[[surface]]
name = "ceiling_lamp"
material = "lamp"
rectangle = { corner = [0.7,1.3,2], u = [0.6,0,0], v = [0,-0.6,0] }
[[medium]]
name = "fog"
extinction = 0.5
albedo = 0.8
fills = "everywhere"
[[camera]]
name = "main"
eye = [0.2,0.2,1.0]
target = [1.5,1.5,0.8]
fov_y = 60.0
width = 16
height = 12
[[camera]]
name = "side"
eye = [1.8,0.2,1.0]
target = [0.5,1.5,0.8]
fov_y = 60.0
width = 8
height = 8
[solve]
error = 0.2
rays = 16
gather_rays = 16
element_size = 1.2
max_elements = 2000
[render]
samples = 4
)";

}  // namespace tyndall::test
