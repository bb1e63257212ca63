from setuptools import setup

NAME = 'backcast_ros2'

setup(
    name=NAME,
    version='0.1.0',
    packages=[NAME],
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
        (f'share/{NAME}/launch', ['launch/localization_launch.py']),
    ],
    install_requires=['setuptools'],
    description='Starts Backcast in the place of nav2_amcl',
    license='MIT OR Apache-2.0',
)
