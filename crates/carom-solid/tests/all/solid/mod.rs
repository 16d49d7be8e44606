//! Parts of a body of one shape.

mod projection;
