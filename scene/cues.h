#pragma once
// Cues that only the picture gives: they change what is drawn, never the contact or the avatar's place. Each has a
// strength, and 0 equals its absence.
//
// The eye tells stiffness from how deep a surface gives way. Size is judged better than speed (Lecuyer, Burkhardt and Tan,
// ACM Trans. Appl. Percept. 5 (2008) 14), and a deforming surface with a procedural crease tells up to eight stiffnesses
// apart with a mouse (Argelaguet et al., ACM Trans. Appl. Percept. 10 (2013) 17).

namespace palpa::scene {

struct DrawnCues {
    double footprint = 0.0;  // a ring round the contact: mm of its radius per mm of depth, beside the indenter's radius
    double crease = 0.0;     // a dark crease at the contact's edge: 1 = as dark as it gets, under deep contacts
    double depth_gain = 0.0;  // the surface and the indenter are drawn (1 + this) times as deep
    bool side_view = false;   // the section through the contact is drawn in a corner; not a change of the tissue
};

// What the cues draw for a contact.
struct CueValues {
    double footprint_m = 0.0;    // radius of the ring; 0: none
    double crease = 0.0;         // darkness, 0 ... 1
    double drawn_depth_m = 0.0;  // equals the contact's depth without depth_gain
};

// Returns what the cues draw. Without a depth nothing is drawn.
CueValues cues_at(const DrawnCues& cues, double indenter_radius_m, double depth_m);

}  // namespace palpa::scene
