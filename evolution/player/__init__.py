"""The agent in the reader's browser: one HTML file that needs nothing else.

    python -m evolution.player --output docs/play/index.html

src/      the world, the network and the player in plain JavaScript, one idea a module
bundle    modules to one script
agents    what the page is told of an agent
page      the HTML
"""
