#version 450 core
// Balls, for what is known before.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "include/newton.glsl"
#include "include/newton_vertex.glsl"
