"""One module for each kind of figure; `page` has what all share."""
