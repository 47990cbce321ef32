// Runs before viser's own script.

// viser reconnects only while its document has the focus; in a frame of our page it seldom has.
document.hasFocus = () => true;
