"""What the OpenGL renderer is made of."""
