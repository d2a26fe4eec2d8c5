% Mirror direction: R = D - 2 (D.N) N. Either side of the surface may be called N.
function mirrored = reflect_ray(direction, normal)
  mirrored = direction - 2 * sum(direction .* normal, 2) .* normal;
end
