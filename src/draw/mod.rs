//! A scene of shapes with units and colours, and its painters: PNG and SVG. The window paints the
//! same scene.
