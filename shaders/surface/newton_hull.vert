#version 450 core
// Hulls, to be searched.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "include/newton.glsl"
#include "include/newton_vertex.glsl"
