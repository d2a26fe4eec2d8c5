// Every kind of light that makes a shape glow.
KIND(diffuse)
