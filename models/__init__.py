"""What the robot and its table are: descriptions from installed packages, scene and appearance.

    import models
    models.get_robot("icub").joints                # those that act
    models.build_model(models.get_robot("icub"))   # robot and table in MuJoCo

`__init__.pyi` names what is here; a name is loaded when it is first used.
"""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
