% Checks the oracle's own pieces against numbers derived by hand. Silent asserts; prints
% one line when all hold, fails with a non-zero exit status otherwise.
%
%   octave --no-gui --norc tests/oracle/self_check.m

addpath(fileparts(mfilename("fullpath")));
tight = 1e-14;

% Sphere of radius 2 around (0 0 5), seen along z: roots 3 and 7; with a direction of
% length 2 half of that; tangent at height 2, both roots 5; a miss above it.
[near, far] = sphere_roots([0 0 0; 0 0 0; 0 2 0; 0 3 0], [0 0 1; 0 0 2; 0 0 1; 0 0 1], ...
                           [0 0 5], 2, false(4, 1));
assert(near, [3; 1.5; 5; NaN], tight);
assert(far, [7; 3.5; 5; NaN], tight);
% From inside one root lies behind; from the surface one root is exactly zero.
[near, far] = sphere_roots([0 0 5; 0 0 3], [0 0 1; 0 0 1], [0 0 5], 2, [false; true]);
assert(near, [-2; 0], 0);
assert(far, [2; 4], 0);
% The far root survives cancellation: a sphere of radius 1e8 whose top is 1 below.
[near, far] = sphere_roots([0 0 0], [0 -1 0], [0 -1e8 - 1, 0], 1e8, false);
assert(far, 2e8 + 1, 1e-7);

% A mirror keeps the tangential part and turns the normal part around.
assert(reflect_ray([3 -4 0] / 5, [0 1 0]), [3 4 0] / 5, tight);
assert(reflect_ray([3 -4 0] / 5, [0 -1 0]), [3 4 0] / 5, tight);

% Snell: entering eta 1.5 at 45 degrees, sin(theta2) = sin(45 deg) / 1.5; coming back
% out the same way restores the first direction.
D = [sind(45), -cosd(45), 0];
[T, total] = refract_ray(D, [0 1 0], 1.5);
assert(T(1), sind(45) / 1.5, tight);
assert(norm(T), 1, tight);
assert(T(2) < 0 && !total);
[back, total] = refract_ray(T, [0 -1 0], 1.5);
assert(back, D, tight);
assert(!total);
% Straight on nothing bends.
assert(refract_ray([0 -1 0], [0 1 0], 1.5), [0 -1 0], tight);
% The critical angle of glass is asin(1 / 1.5) = 41.81 degrees: refracted just below it,
% mirrored just above it. A bubble (eta 1 / 1.5) is total on entering instead.
[~, total] = refract_ray([sind(41.8), cosd(41.8), 0], [0 1 0], 1.5);
assert(!total);
[T, total] = refract_ray([sind(41.9), cosd(41.9), 0], [0 1 0], 1.5);
assert(total && T(2) < 0);
assert(T, [sind(41.9), -cosd(41.9), 0], tight);
[~, total] = refract_ray([sind(41.9), -cosd(41.9), 0], [0 1 0], 1 / 1.5);
assert(total);

% One white sphere, ka Ia = 0.05, light straight above its top: with kd = 0.5, ks = 0.25
% and n = 2, seen from 60 degrees: 0.05 + (0.5 + 0.25 cos(60 deg)^2) * 0.8 = 0.5.
scene = struct("centre", [0 0 0], "radius", 1, "ambient", [0.1 0.1 0.1], ...
    "ambient_color", [0.5 0.5 0.5], "diffuse", [0.5 0.5 0.5], "specular", [0.25 0.25 0.25], ...
    "shininess", 2, "reflectivity", 0, "transparency", 0, "eta", 1, ...
    "lights", struct("from", [0 3 0], "intensity", [0.8 0.8 0.8], "inverse_square", false));
view = [sind(60), cosd(60), 0];
[color, lit] = local_light(scene, [0 1 0], [0 1 0], view, 1);
assert(color, [0.5 0.5 0.5], tight);
assert(lit, 1);
% The light is 2 away: by the inverse square a quarter of it arrives.
scene.lights.inverse_square = true;
assert(local_light(scene, [0 1 0], [0 1 0], view, 1), 0.05 + [0.45 0.45 0.45] / 4, tight);
% Below the sphere only the ambient part is left, be it by L.N < 0 ...
assert(local_light(scene, [0 -1 0], [0 -1 0], [0 -1 0], 1), [0.05 0.05 0.05], tight);
% ... or, seen from inside, by the sphere's own shadow.
assert(local_light(scene, [0 -1 0], [0 1 0], [0 1 0], 1), [0.05 0.05 0.05], tight);
% A ray that starts on the sphere does not meet it again on its way out.
assert(intersect_scene(scene, [0 1 0], [1 1e-12 0], 1), Inf);

% Two mirrors facing each other with local light a each, kr = 1/2 and three levels give
% a/2 + (1/2) (a/2 + (1/2) (a/2)) = 7/8 a.
pair = scene;
pair.centre = [0 0 3; 0 0 -3];
for field = {"radius", "shininess", "transparency", "eta"}
  pair.(field{1}) = pair.(field{1}) * [1; 1];
end
pair.reflectivity = [0.5; 0.5];
pair.ambient_color = ones(2, 3);
pair.diffuse = zeros(2, 3);
pair.specular = zeros(2, 3);
assert(trace_rays(pair, [0 0 0], [0 0 1], 0, 3, 1), 0.1 * 7 / 8 * [1 1 1], tight);

% The camera: +x to the right, rows from the top, fov over the shorter side.
view = struct("width", 4, "height", 2, "fov", 90, "camera_from_world", eye(4));
[~, D] = camera_rays(view);
assert(D(1, :) / D(1, 3), [-1.5 0.5 1], tight);
assert(D(end, :) / D(end, 3), [1.5 -0.5 1], tight);

printf("oracle: all self checks passed\n");
