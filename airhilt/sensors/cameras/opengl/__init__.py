"""Parts of the OpenGL renderer."""
