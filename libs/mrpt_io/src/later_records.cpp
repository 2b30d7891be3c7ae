#include "later_records.hpp"

#include <array>
#include <iostream>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include <mrpt/core/aligned_std_vector.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/math/CMatrixFixed.h>
#include <mrpt/math/matrix_serialization.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>

namespace traverse::mrpt_io {

namespace {

using mrpt::serialization::CArchive;

[[noreturn]] void refuse_version(const char* class_name, std::uint8_t version) {
  throw std::runtime_error(std::string(class_name) + " of version " + std::to_string(version));
}

/// Whether a value follows: a std::optional stands behind its own name and that of the type.
bool optional_follows(CArchive& archive) {
  std::string name;
  std::string type;
  archive >> name >> type;
  if (name != "std::optional") throw std::runtime_error("no std::optional, but " + name);
  bool has_value = false;
  archive >> has_value;
  return has_value;
}

template <typename Number>
std::vector<Number> read_numbers(CArchive& archive, std::uint32_t count) {
  std::vector<Number> numbers(count);
  if (count > 0) archive.ReadBufferFixEndianness(numbers.data(), count);
  return numbers;
}

template <typename Number>
std::vector<Number> read_counted(CArchive& archive) {
  return read_numbers<Number>(archive, archive.ReadAs<std::uint32_t>());
}

/// Version 1 no longer holds whether points may be deleted.
void read_insertion_options(CArchive& archive, mrpt::maps::CPointsMap::TInsertionOptions& options) {
  const auto version = archive.ReadAs<std::int8_t>();
  if (version != 0 && version != 1)
    refuse_version("TInsertionOptions", static_cast<std::uint8_t>(version));
  archive >> options.minDistBetweenLaserPoints >> options.addToExistingPointsMap >>
      options.also_interpolate;
  if (version == 0) archive >> options.disableDeletion;
  archive >> options.fuseWithExisting >> options.isPlanarMap >> options.horizontalTolerance >>
      options.maxDistForInterpolatePoints >> options.insertInvalidPoints;
}

class LaterGps final : public mrpt::obs::CObservationGPS {
 protected:
  void serializeFrom(CArchive& archive, std::uint8_t version) override {
    if (version < 12) {
      CObservationGPS::serializeFrom(archive, version);
      return;
    }
    if (version > 13) refuse_version("CObservationGPS", version);
    clear();
    archive >> timestamp >> originalReceivedTimestamp >> sensorLabel >> sensorPose;
    archive >> has_satellite_timestamp;
    if (optional_follows(archive)) {
      mrpt::math::CMatrixDouble33 covariance;
      archive >> covariance;
    }
    if (version >= 13) {
      archive.ReadAs<std::uint8_t>();   // kind of fix
      archive.ReadAs<std::uint16_t>();  // services
    }
    const auto count = archive.ReadAs<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
      auto* message = mrpt::obs::gnss::gnss_message::readAndBuildFromStream(archive);
      messages[message->message_type] = mrpt::obs::gnss::gnss_message_ptr(message);
    }
  }
};

class LaterRangeScan final : public mrpt::obs::CObservation2DRangeScan {
 protected:
  void serializeFrom(CArchive& archive, std::uint8_t version) override {
    if (version < 8) {
      CObservation2DRangeScan::serializeFrom(archive, version);
      return;
    }
    if (version > 8) refuse_version("CObservation2DRangeScan", version);
    CObservation2DRangeScan::serializeFrom(archive, 7);
    archive.ReadAs<float>();  // duration of the sweep
  }
};

class LaterComment final : public mrpt::obs::CObservationComment {
 protected:
  void serializeFrom(CArchive& archive, std::uint8_t version) override {
    if (version > 1) refuse_version("CObservationComment", version);
    CObservationComment::serializeFrom(archive, 0);
    if (version == 1) archive >> sensorLabel;
  }
};

class LaterSimplePoints final : public mrpt::maps::CSimplePointsMap {
 protected:
  void serializeFrom(CArchive& archive, std::uint8_t version) override {
    if (version != 10) {
      CSimplePointsMap::serializeFrom(archive, version);
      return;
    }
    mark_as_modified();
    const auto count = archive.ReadAs<std::uint32_t>();
    resize(count);
    if (count > 0) {
      archive.ReadBufferFixEndianness(m_x.data(), count);
      archive.ReadBufferFixEndianness(m_y.data(), count);
      archive.ReadBufferFixEndianness(m_z.data(), count);
    }
    archive >> genericMapParams;
    read_insertion_options(archive, insertionOptions);
    likelihoodOptions.readFromStream(archive);
    renderOptions.readFromStream(archive);
  }
};

class LaterXyzi final : public mrpt::maps::CPointsMapXYZI {
 protected:
  void serializeFrom(CArchive& archive, std::uint8_t version) override {
    if (version != 0) refuse_version("CPointsMapXYZI", version);
    mark_as_modified();
    const auto count = archive.ReadAs<std::uint32_t>();
    resize(count);
    if (count > 0) {
      archive.ReadBufferFixEndianness(m_x.data(), count);
      archive.ReadBufferFixEndianness(m_y.data(), count);
      archive.ReadBufferFixEndianness(m_z.data(), count);
      archive.ReadBufferFixEndianness(m_intensity.data(), count);
    }
    read_insertion_options(archive, insertionOptions);
    likelihoodOptions.readFromStream(archive);
  }
};

class Xyzirt final : public LaterPoints {
 protected:
  void serializeFrom(CArchive& archive, std::uint8_t version) override {
    if (version != 0) refuse_version("CPointsMapXYZIRT", version);
    read_coordinates(archive);
    keep("intensity", read_counted<float>(archive));
    keep("ring", read_counted<std::uint16_t>(archive));
    keep("t", read_counted<float>(archive));
    read_options(archive);
  }
};

class GenericPoints final : public LaterPoints {
 protected:
  void serializeFrom(CArchive& archive, std::uint8_t version) override {
    if (version > 4) refuse_version("CGenericPointsMap", version);
    read_coordinates(archive);
    read_fields<float>(archive, version);
    if (version >= 1) read_fields<double>(archive, version);
    read_fields<std::uint16_t>(archive, version);
    if (version >= 2) read_fields<std::uint8_t>(archive, version);
    if (version >= 4) read_fields<std::uint32_t>(archive, version);
    read_options(archive);
  }

 private:
  template <typename Number>
  void read_fields(CArchive& archive, std::uint8_t version) {
    const auto count = archive.ReadAs<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
      std::string name;
      archive >> name;
      if (version >= 3) {
        keep(name, read_counted<Number>(archive));
      } else {  // a container behind its own name and that of the type
        mrpt::aligned_std_vector<Number> values;
        archive >> values;
        keep(name, std::vector<Number>(values.begin(), values.end()));
      }
    }
  }
};

template <typename Class>
std::shared_ptr<mrpt::rtti::CObject> make_object() {
  return std::make_shared<Class>();
}

/// A class under MRPT's name of it; kept for the life of the program, as MRPT's registry refers to
/// it.
template <typename Class, typename Base>
void read_as(const char* name) {
  static const mrpt::rtti::TRuntimeClassId kId{name, &make_object<Class>,
                                               [] { return &Base::GetRuntimeClassIdStatic(); }};
  mrpt::rtti::registerClassCustomName(name, &kId);
}

}  // namespace

void LaterPoints::read_coordinates(CArchive& archive) {
  mark_as_modified();
  const auto count = archive.ReadAs<std::uint32_t>();
  resize(count);
  if (count == 0) return;
  archive.ReadBufferFixEndianness(m_x.data(), count);
  archive.ReadBufferFixEndianness(m_y.data(), count);
  archive.ReadBufferFixEndianness(m_z.data(), count);
}

void LaterPoints::read_options(CArchive& archive) {
  read_insertion_options(archive, insertionOptions);
  likelihoodOptions.readFromStream(archive);
}

void read_later_records() {
  static std::once_flag once;
  std::call_once(once, [] {
    mrpt::rtti::registerAllPendingClasses();
    // MRPT complains of each name that is taken already; that is what is wanted here.
    std::streambuf* const complaints = std::cerr.rdbuf(nullptr);
    using namespace mrpt::obs;
    using namespace mrpt::maps;
    read_as<LaterGps, CObservationGPS>("mrpt::obs::CObservationGPS");
    read_as<LaterRangeScan, CObservation2DRangeScan>("mrpt::obs::CObservation2DRangeScan");
    read_as<LaterComment, CObservationComment>("mrpt::obs::CObservationComment");
    read_as<LaterSimplePoints, CSimplePointsMap>("mrpt::maps::CSimplePointsMap");
    read_as<LaterXyzi, CPointsMapXYZI>("mrpt::maps::CPointsMapXYZI");
    read_as<Xyzirt, CPointsMapXYZI>("mrpt::maps::CPointsMapXYZIRT");
    read_as<GenericPoints, CPointsMapXYZI>("mrpt::maps::CGenericPointsMap");
    std::cerr.rdbuf(complaints);
  });
}

}  // namespace traverse::mrpt_io
