// Every light chooser, by its name as the integrators' parameter "lightsampler".
CHOOSER(uniform)
CHOOSER(power)
CHOOSER(bvh)
