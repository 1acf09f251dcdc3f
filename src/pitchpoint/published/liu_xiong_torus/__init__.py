"""Liu and Xiong, Dynamic characteristics of torus involute gear drive."""
