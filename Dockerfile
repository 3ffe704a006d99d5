# The page, built by Node; nothing of Node reaches the final image.
FROM node:22-bookworm-slim AS page
WORKDIR /src/frontend
COPY frontend/package.json frontend/package-lock.json frontend/.npmrc ./
RUN npm ci
COPY frontend/ ./
RUN npm run build

FROM python:3.11-slim-bookworm AS base
# OpenMP, for the solver ProxQP
# hadolint ignore=DL3008
RUN apt-get update \
    && apt-get install --yes --no-install-recommends libgomp1 \
    && rm -rf /var/lib/apt/lists/*

# The program and its locked dependencies, in a virtual environment that is copied as a whole.
FROM base AS program
# hadolint ignore=DL3008
RUN apt-get update && apt-get install --yes --no-install-recommends g++
ENV PATH=/opt/stairwright/bin:$PATH \
    PIP_DISABLE_PIP_VERSION_CHECK=1 \
    PIP_NO_CACHE_DIR=1
WORKDIR /src
RUN python -m venv /opt/stairwright
COPY requirements.lock requirements-studies.lock slim.py ./
# Without what running needs not; libraries that a wheel holds twice become one.
RUN pip install --require-hashes --requirement requirements.lock --requirement requirements-studies.lock \
    && python slim.py
COPY pyproject.toml hatch_build.py README.md LICENSE ./
COPY terrains/ terrains/
COPY robots/ robots/
COPY backend/ backend/
COPY native/ native/
RUN cmake -S native -B /tmp/native -G Ninja -DPython_EXECUTABLE="$(command -v python)" \
    && cmake --build /tmp/native \
    && cmake --install /tmp/native --prefix backend/stairwright
COPY --from=page /src/frontend/dist/ frontend/dist/
# What built it stays behind.
RUN pip install --no-deps --no-build-isolation . \
    && pip uninstall --yes cmake hatchling nanobind ninja pip \
    && python -m stairwright.warmup

FROM base
LABEL org.opencontainers.image.title="Stairwright" \
      org.opencontainers.image.licenses="MIT"
RUN useradd --uid 10001 --user-group --no-create-home --home-dir /data stairwright \
    && install --directory --owner stairwright --group stairwright /data
COPY --from=program /opt/stairwright/ /opt/stairwright/
# Only /data and /tmp are written to, so the root file system may be read-only.
ENV PATH=/opt/stairwright/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    PYTHONDONTWRITEBYTECODE=1 \
    MUJOCO_GL=disable \
    STAIRWRIGHT_DATA=/data
USER 10001:10001
WORKDIR /data
VOLUME /data
EXPOSE 8000
HEALTHCHECK --interval=15s --timeout=5s --start-period=120s --retries=3 \
    CMD ["python", "-c", "import urllib.request as r; r.urlopen('http://127.0.0.1:8000/api/v1/healthz', timeout=4)"]
ENTRYPOINT ["stairwright"]
# Others can reach a container, so serving from one asks for a secret: set STAIRWRIGHT_TOKEN.
CMD ["serve", "--host", "0.0.0.0", "--port", "8000"]
