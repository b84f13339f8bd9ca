#pragma once
// The few OpenGL objects that drawing needs, freed by their destructors. They use OpenGL ES 3.0, so that the same shaders
// run on the desktop and in a browser.

#include <GLES3/gl3.h>
#include <string>
#include <vector>

namespace palpa::render {

class Program {
  public:
    // Throws std::runtime_error with the message of the shader compiler.
    Program(const char* vertex_source, const char* fragment_source);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    void use() const { glUseProgram(id_); }
    GLint uniform(const char* name) const { return glGetUniformLocation(id_, name); }

  private:
    GLuint id_ = 0;
};

// Indexed vertices with two floats at location 0 and, if they were set, three floats at location 1 that change from frame
// to frame.
class Mesh {
  public:
    Mesh(const std::vector<float>& points, const std::vector<unsigned>& triangles);
    ~Mesh();
    Mesh(const Mesh&) = delete;
    Mesh& operator=(const Mesh&) = delete;
    void set_second(const std::vector<float>& values);
    void draw() const;

  private:
    GLuint vertex_array_ = 0;
    GLuint buffers_[3] = {0, 0, 0};
    GLsizei count_ = 0;
};

// A copy of the drawing area, to be drawn again without its shaders.
class AreaCopy {
  public:
    AreaCopy();
    ~AreaCopy();
    AreaCopy(const AreaCopy&) = delete;
    AreaCopy& operator=(const AreaCopy&) = delete;
    bool take(int width_px, int height_px);  // of what was drawn last; false: this driver cannot
    void put() const;

  private:
    GLuint texture_ = 0;
    GLuint framebuffer_ = 0;
    int width_px_ = 0;
    int height_px_ = 0;
};

// A square picture with four channels, drawn once and then used on surfaces, over which it repeats.
class Texture {
  public:
    explicit Texture(int side_px);
    ~Texture();
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;
    bool begin();  // what is drawn next goes to the texture, until end(); false: this driver cannot
    void end();
    void bind(bool much_smaller) const;  // much_smaller: fewer pixels than half its own show it

  private:
    int side_px_ = 0;
    GLuint texture_ = 0;
    GLuint framebuffer_ = 0;
};

// A drawing area of its own, with depth, to be shown larger or smaller than it was drawn.
class Layer {
  public:
    Layer();
    ~Layer();
    Layer(const Layer&) = delete;
    Layer& operator=(const Layer&) = delete;
    bool begin(int width_px, int height_px);  // what is drawn next goes here, until show(); false: this driver cannot
    void show(int width_px, int height_px);   // in the window, stretched to this size

  private:
    GLuint framebuffer_ = 0;
    GLuint buffers_[2] = {0, 0};  // colour, depth
    int width_px_ = 0;
    int height_px_ = 0;
};

// True if the driver computes pictures on the processor.
bool draws_in_software();

void clear_screen(int width_px, int height_px);

// Returns the picture that was drawn last as rows of RGB, from the top downwards.
std::vector<unsigned char> read_pixels(int width_px, int height_px);

}  // namespace palpa::render
