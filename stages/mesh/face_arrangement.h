#pragma once

#include <vector>

#include "stages/mesh/overlay.h"

namespace strake {

/// Inserts the chords of one face after the other into an overlay.
class FaceArrangement {
 public:
  struct Chord {
    Index from = kNone;  ///< node on the outline of the face
    Index to = kNone;    ///< another
    Index line = kNone;
  };

  /// \pre the overlay has no crossings yet
  FaceArrangement(const TriMesh& mesh, Overlay& overlay)
      : mesh_(mesh), overlay_(overlay), position_(overlay.nodes.size()) {}

  /// \param first  dart that starts the outline at corner 0 of the face
  /// \param chords whose ends lie on the outline; at most one ends in each node but the corners
  void insert(Index face, Index first, const std::vector<Chord>& chords);

 private:
  struct Ends {
    Index from = 0;  ///< positions along the outline
    Index to = 0;
  };
  struct Placed {
    Vec3 a;  ///< barycentric
    Vec3 b;
    bool pending = false;  ///< still to be crossed by the chord being inserted
    double at = 0;         ///< where, along that chord
  };

  void walk_outline(Index face, Index first);
  void insert_chord(Index face, const Chord& chord);
  Index start_corner(const Chord& chord) const;
  Index next_crossing(Index corner) const;
  Index cross(Index corner, Index dart, Index face, const Vec3& barycentric);
  void label(Index edge, EdgeKind kind, Index line, Index chord);
  /// The chord of the present face that a dart is a piece of; kNone where it is on the outline.
  [[nodiscard]] Index chord_of(Index dart) const;

  const TriMesh& mesh_;
  Overlay& overlay_;
  std::vector<Index> position_;  ///< [nodes on edges] along the outline of the present face
  /// Of the present face:
  std::vector<Index> outline_dart_;  ///< [positions] outline dart that leaves the node there
  std::vector<Vec3> barycentric_;    ///< [positions]
  /// [chords] as inserted; apart, as each new chord looks at the ends of all before.
  std::vector<Ends> ends_;
  std::vector<Placed> placed_;
  Index first_edge_ = 0;      ///< all edges from this one on are pieces of chords
  std::vector<Index> chord_;  ///< [edges from first_edge_ on]
};

}  // namespace strake
