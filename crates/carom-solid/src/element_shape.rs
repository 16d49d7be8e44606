//! The shape of an element, a compile-time type, from its name at run time.

/// `$function::<D, N, S>($arguments)` for the shape of an element of dimension D, the first
/// argument; `$other` for elements of other dimensions.
macro_rules! of_shape {
    (1, $element:expr, $function:ident($($argument:expr),*), $other:expr) => {
        $crate::element_shape::of_shape!(@ $element, $function($($argument),*), $other;
            L2 => 1, 2, Line2; L3 => 1, 3, Line3; L4 => 1, 4, Line4)
    };
    (2, $element:expr, $function:ident($($argument:expr),*), $other:expr) => {
        $crate::element_shape::of_shape!(@ $element, $function($($argument),*), $other;
            T3 => 2, 3, Tri3; T6 => 2, 6, Tri6; T10 => 2, 10, Tri10; Q4 => 2, 4, Quad4; Q9 => 2, 9, Quad9)
    };
    (3, $element:expr, $function:ident($($argument:expr),*), $other:expr) => {
        $crate::element_shape::of_shape!(@ $element, $function($($argument),*), $other;
            Tet4 => 3, 4, Tet4; Tet10 => 3, 10, Tet10; Tet20 => 3, 20, Tet20;
            Hex8 => 3, 8, Hex8; Hex27 => 3, 27, Hex27)
    };
    (@ $element:expr, $function:ident $arguments:tt, $other:expr;
        $($name:ident => $d:literal, $n:literal, $shape:ident);+) => {
        match $element {
            $($crate::Element::$name => $function::<$d, $n, $crate::shape::$shape> $arguments,)+
            _ => $other,
        }
    };
}

pub(crate) use of_shape;
