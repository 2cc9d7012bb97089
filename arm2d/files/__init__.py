"""Files on a machine shared with others: what is written goes where it was sent, what is read is a file.

Whoever may write in a folder can put a symbolic link or a pipe there, and can take a name that is easily
guessed before we do. So

    a folder that is a link    is entered if the link is ours or root's; this holds for the whole way to it
    a file that is a link      is never written to
    a temporary file           has a random name, and is made anew, never opened
    what is read               is a regular file of at most so many bytes
"""

from arm2d.files.folders import LinkError, opened_folder
from arm2d.files.handles import handle_of_new, handle_to_append, handle_to_overwrite, handle_to_rewrite
from arm2d.files.locks import lock_file
from arm2d.files.reading import NoFileError, read_file, read_with_status
from arm2d.files.writing import final_name, is_temporary, write_whole

__all__ = [
    "LinkError",
    "NoFileError",
    "final_name",
    "handle_of_new",
    "handle_to_append",
    "handle_to_overwrite",
    "handle_to_rewrite",
    "is_temporary",
    "lock_file",
    "opened_folder",
    "read_file",
    "read_with_status",
    "write_whole",
]
